#include "core/occlusion/reordered.h"

#include <algorithm>
#include <set>

#include "tests/support/agreement.h"
#include "tests/support/batches.h"
#include "tests/support/covers.h"
#include "tests/support/mixtures.h"

// The order of the rays in a batch must not change any result.
namespace orrery::test {
namespace {

template <class T>
std::shared_ptr<const Accelerator<T>> reorder(const PrimitiveList<T>&,
                                              std::shared_ptr<const Accelerator<T>> behind) {
  return reordered(std::move(behind));
}

class Reordering : public testing::TestWithParam<std::string> {
 protected:
  template <class T>
  void agree(const Json& scene, const Rays<T>& rays) {
    Structure<T> reference(scene, "list"), sorted(scene, GetParam(), reorder<T>);
    expect_agreement<T>(sorted, reference, rays, {T(0.5), T(4), std::numeric_limits<T>::infinity()});
  }
  template <class T>
  void agree_on_all() {
    for (const Json& scene : {balls(200, 1), mixture(1)}) {
      agree<T>(scene, any_rays<T>(3, 20'000, 2));
      agree<T>(scene, rays_from_one_point<T>(3, 5'000, 3));
      agree<T>(scene, Rays<T>(3'000, {{T(0.1), T(0.2), T(-5)}, {T(0), T(0), T(1)}}));
      agree<T>(scene, invalid_rays<T>(3'000, 4));
    }
  }
};

TEST_P(Reordering, PreservesHitsAndShadows) {
  covers("F17");
  agree_on_all<float>();
  agree_on_all<double>();
}

INSTANTIATE_TEST_SUITE_P(All, Reordering, testing::ValuesIn(accelerator_names()), parameter_name);

template <class T>
std::vector<int> order_in(const Rays<T>& rays) {
  const auto batch = std::make_unique<RayBatch<T>>();
  fill_batch<T>(rays, T(1), *batch);
  const RayOrder order = order_of(*batch, groups_of(*batch));
  return {order.place.begin(), order.place.begin() + order.count};
}

std::vector<int> ascending(int count) {
  std::vector<int> numbers;
  for (int i = 0; i < count; ++i) numbers.push_back(i);
  return numbers;
}

template <class T>
class RayOrders : public testing::Test {};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(RayOrders, Numbers);

TYPED_TEST(RayOrders, ContainsEachActiveRayOnce) {
  covers("F17");
  using T = TypeParam;
  for (const int count : {1, 7, 16, 500, kBatch}) {
    const auto batch = std::make_unique<RayBatch<T>>();
    fill_batch<T>(any_rays<T>(3, count, 5), T(1), *batch);
    std::vector<int> active;
    for (int i = 0; i < count; ++i) {
      if (i % 3 == 1) batch->t_max[i] = T(-1);
      if (i % 3 != 1) active.push_back(i);
    }
    const RayOrder order = order_of(*batch, groups_of(*batch));
    std::vector<int> found(order.place.begin(), order.place.begin() + order.count);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, active);
  }
  const auto nobody = std::make_unique<RayBatch<T>>();
  nobody->t_max.values.fill(T(-1));
  EXPECT_EQ(order_of(*nobody, LaneGroups::covering(0, kBatch, kWidth<T>)).count, 0);
}

TYPED_TEST(RayOrders, SortsEqualKeysStably) {
  covers("F17");
  using T = TypeParam;
  const Rays<T> same(900, {{T(1), T(2), T(3)}, {T(0), T(1), T(0)}});
  EXPECT_EQ(order_in<T>(same), ascending(900));
  std::vector<int> expected;  // the even rays, then the odd ones
  for (const int kind : {0, 1})
    for (int i = kind; i < 600; i += 2) expected.push_back(i);
  Rays<T> places, directions;
  for (int i = 0; i < 600; ++i) {
    places.push_back({{T(i % 2), T(0), T(0)}, {T(0), T(1), T(0)}});
    // The two directions are in adjacent cells of direction space.
    directions.push_back({{T(0), T(0), T(0)}, {T(i % 2) / 5, T(1), T(0)}});
  }
  EXPECT_EQ(order_in<T>(places), expected);
  EXPECT_EQ(order_in<T>(directions), expected);
}

TYPED_TEST(RayOrders, GroupsNearbyOrigins) {
  using T = TypeParam;
  Random random(6);
  Rays<T> rays;
  for (int i = 0; i < 1000; ++i) {
    const int place = random.below(8);
    const Vec3d corner(place & 1, place >> 1 & 1, place >> 2);
    rays.push_back({Vec3<T>(corner * 10.0 + random.in_cube(0.01)), Vec3<T>(random.direction())});
  }
  const auto corner_of = [&](int i) {
    const Vec3<T>& o = rays[static_cast<std::size_t>(i)].origin;
    return (o.x > 5) + 2 * (o.y > 5) + 4 * (o.z > 5);
  };
  int changes = 0;
  const std::vector<int> order = order_in<T>(rays);
  for (std::size_t i = 1; i < order.size(); ++i) changes += corner_of(order[i]) != corner_of(order[i - 1]);
  EXPECT_EQ(changes, 7);
}

// Rays from one point are sorted by the octants of their directions.
TYPED_TEST(RayOrders, SortsSharedOriginByOctant) {
  covers("F17");
  using T = TypeParam;
  const Rays<T> rays = rays_from_one_point<T>(3, 1000, 7);
  const auto octant_of = [&](int i) {
    const Vec3<T>& d = rays[static_cast<std::size_t>(i)].direction;
    return (d.x >= 0) * 4 + (d.y >= 0) * 2 + (d.z >= 0);
  };
  const std::vector<int> order = order_in<T>(rays);
  EXPECT_TRUE(
      std::is_sorted(order.begin(), order.end(), [&](int a, int b) { return octant_of(a) < octant_of(b); }));
}

TYPED_TEST(RayOrders, PlacesNanInLowestCell) {
  covers("F17");
  using T = TypeParam;
  const T nan = std::numeric_limits<T>::quiet_NaN();
  const Rays<T> rays = {{{T(1), T(1), T(1)}, {T(1), T(1), T(1)}},
                        {{T(0), T(0), T(0)}, {T(-1), T(-1), T(-1)}},
                        {{nan, nan, nan}, {nan, nan, nan}},
                        {{T(0), T(0), T(0)}, {T(1), T(1), T(1)}}};
  EXPECT_EQ(order_in<T>(rays), (std::vector<int>{1, 2, 3, 0}));
}

TYPED_TEST(RayOrders, LeavesInactiveRaysUnchanged) {
  using T = TypeParam;
  Structure<T> sorted(balls(20, 1), "bvh", reorder<T>);
  const auto batch = std::make_unique<RayBatch<T>>();
  const auto hits = std::make_unique<HitBatch<T>>();
  fill_batch<T>(any_rays<T>(1, kBatch, 8), std::numeric_limits<T>::infinity(), *batch);
  for (int i = 0; i < kBatch; i += 2) batch->t_max[i] = T(-1);
  hits->t = batch->t_max;
  hits->primitive.values.fill(-7);
  AcceleratorCounts counts;
  const LaneGroups first_half = LaneGroups::covering(0, kBatch / 2, kWidth<T>);
  const RayBatch<T> before = *batch;
  for (int i = 1; i < kBatch; i += 2) hits->primitive[i] = kNoPrimitive;
  sorted.accelerator()->closest(*batch, first_half, *hits, counts);
  sorted.accelerator()->occlude(*batch, first_half, counts);
  for (int i = 0; i < kBatch; ++i) {
    if (i < kBatch / 2 && i % 2 == 1) continue;
    EXPECT_EQ(batch->t_max[i], before.t_max[i]) << i;
    EXPECT_EQ(hits->t[i], before.t_max[i]) << i;
    EXPECT_EQ(hits->primitive[i], i % 2 == 0 ? -7 : kNoPrimitive) << i;
  }
}

}  // namespace
}  // namespace orrery::test
