#include "core/model/record.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/random.h"

namespace orrery {
namespace {

template <class N>
struct Body {
  Vec3<N> place;
  N size;
};

template <class T>
class Records : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Records, Scalars);

TYPED_TEST(Records, FetchesOneRecordPerLane) {
  using T = TypeParam;
  using N = Lanes<T>;
  std::vector<Body<T>> table;
  for (int i = 0; i < 50; ++i) table.push_back({{T(i), T(100 + i), T(200 + i)}, T(300 + i)});
  test::Random random(1);
  for (int trial = 0; trial < 500; ++trial) {
    IndexLanes<T> index;
    typename N::mask_type mask(false);
    for (std::size_t lane = 0; lane < N::size(); ++lane) {
      mask[lane] = trial % 5 == 0 || random.below(3) > 0;
      // Inactive lanes may hold any value.
      index[lane] =
          mask[lane] ? static_cast<IndexOf<T>>(trial % 2 ? 7 : random.below(50)) : IndexOf<T>(-1000);
    }
    if (!any(mask)) continue;
    const Body<N> got = fetch_records<Body, T>(table, index, mask);
    for (std::size_t lane = 0; lane < N::size(); ++lane) {
      if (!mask[lane]) continue;
      const Body<T>& expected = table[static_cast<std::size_t>(index[lane])];
      EXPECT_EQ(got.place.x[lane], expected.place.x);
      EXPECT_EQ(got.place.z[lane], expected.place.z);
      EXPECT_EQ(got.size[lane], expected.size);
    }
  }
}

TYPED_TEST(Records, ConvertsPrecisionOfEachField) {
  using T = TypeParam;
  const Body<T> got = convert_record<Body, T>(Body<double>{{0.1, 0.2, 0.3}, 1e-5});
  EXPECT_EQ(got.place.y, static_cast<T>(0.2));
  EXPECT_EQ(got.size, static_cast<T>(1e-5));
}

TYPED_TEST(Records, CoversEveryRayWithLaneGroups) {
  constexpr int width = kWidth<TypeParam>;
  for (const int count : {0, 1, width - 1, width, width + 1, kBatch}) {
    const LaneGroups all = LaneGroups::covering(0, count, width);
    EXPECT_EQ(all.size(), (count + width - 1) / width);
    int next = 0;
    for (const int first : all) {
      EXPECT_EQ(first, next);
      next += width;
    }
  }
}

}  // namespace
}  // namespace orrery
