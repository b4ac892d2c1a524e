#include "core/math/compress.h"

#include <gtest/gtest.h>

#include <array>

#include "tests/support/random.h"

namespace orrery {
namespace {

template <class T>
class Compress : public testing::Test {};
using Scalars = testing::Types<float, double, std::int32_t, std::int64_t>;
TYPED_TEST_SUITE(Compress, Scalars);

template <class T>
struct Register {
  using type = stdx::rebind_simd_t<T, std::conditional_t<sizeof(T) == 4, Lanes<float>, Lanes<double>>>;
};

TYPED_TEST(Compress, KeepsMaskedLanesInOrder) {
  using T = TypeParam;
  using V = typename Register<T>::type;
  V v;
  for (std::size_t i = 0; i < V::size(); ++i) v[i] = static_cast<T>(100 + i);
  for (unsigned bits = 0; bits < (1u << V::size()); ++bits) {
    std::array<T, 2 * V::size()> to{};
    compress_store(v, bits, to.data());
    std::size_t n = 0;
    for (std::size_t i = 0; i < V::size(); ++i)
      if (bits >> i & 1u) {
        EXPECT_EQ(to[n++], static_cast<T>(100 + i)) << "mask " << bits;
      }
    for (std::size_t i = V::size(); i < to.size(); ++i) EXPECT_EQ(to[i], T(0)) << "wrote beyond one register";
  }
}

TYPED_TEST(Compress, PacksMaskWithLaneZeroLowest) {
  using T = TypeParam;
  using V = typename Register<T>::type;
  test::Random random(5);
  for (int trial = 0; trial < 200; ++trial) {
    V v;
    unsigned expected = 0;
    for (std::size_t i = 0; i < V::size(); ++i) {
      const bool set = random.below(2) == 1;
      v[i] = static_cast<T>(set);
      expected |= static_cast<unsigned>(set) << i;
    }
    EXPECT_EQ(bits_of(v > V(T(0))), expected);
  }
}

}  // namespace
}  // namespace orrery
