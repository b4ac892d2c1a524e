#include "core/math/hemisphere.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/math/sampling.h"
#include "tests/support/covers.h"

// Compares sampled directions around a normal with form factors.
namespace orrery {
namespace {

// Returns the fraction of the points on a unit cube's face z = 0 from which a ray along `d` exits through the
// opposite face.
double share_opposite(const Vec3d& d) {
  return std::max(0.0, 1 - std::abs(d.x / d.z)) * std::max(0.0, 1 - std::abs(d.y / d.z));
}
// Returns the fraction of these points from which the ray exits through the side face that `dx` points to.
// `reach` is the distance along x at which a ray reaches the opposite face, at most 1. `turn` is the distance
// along x per unit along y.
double share_of_side(double dx, double dy, double dz) {
  const double reach = std::min(1.0, std::abs(dx / dz)), turn = std::abs(dx / dy);
  return reach < turn ? reach - reach * reach / (2 * turn) : turn / 2;
}

// Returns the fraction of cosine-distributed rays from uniform points of face `from` that reach each face.
// Face 2 * axis + 1 is the upper face on an axis, and face 2 * axis is the lower face.
std::array<double, 6> form_factors(std::size_t from) {
  constexpr std::uint32_t kStreams = 16, kSamples = 1 << 16;
  const std::size_t z = from / 2, x = (z + 1) % 3, y = (z + 2) % 3;
  Vec3d normal;
  normal[z] = from % 2 == 1 ? -1 : 1;
  std::array<double, 6> shares{};
  for (std::uint32_t stream = 0; stream < kStreams; ++stream)
    for (std::uint32_t sample = 0; sample < kSamples; ++sample) {
      const auto point = stratified_point(sample, mix_bits(stream));
      const Vec3d d = cosine_direction(normal, double{point.u}, double{point.v});
      shares[from ^ 1u] += share_opposite({d[x], d[y], d[z]});
      shares[2 * x + (d[x] > 0)] += share_of_side(d[x], d[y], d[z]);
      shares[2 * y + (d[y] > 0)] += share_of_side(d[y], d[x], d[z]);
    }
  for (double& share : shares) share /= double{kStreams} * kSamples;
  return shares;
}

// Form factor of opposite faces of a cube (Howell, "A Catalog of Radiation Heat Transfer Configuration
// Factors", C-11). The four side faces share the remainder equally.
TEST(Hemisphere, MatchesFormFactorsOfCube) {
  test::covers("light-16");
  const double root2 = std::numbers::sqrt2, pi = std::numbers::pi;
  const double opposite = 2 / pi * (std::log(std::sqrt(4.0 / 3)) + 2 * root2 * std::atan(1 / root2) - pi / 2);
  ASSERT_NEAR(opposite, 0.199825, 5e-7);
  for (std::size_t from = 0; from < 6; ++from) {
    const std::array<double, 6> shares = form_factors(from);
    for (std::size_t face = 0; face < 6; ++face) {
      const double expected = face == from ? 0 : (face ^ 1u) == from ? opposite : (1 - opposite) / 4;
      EXPECT_NEAR(shares[face], expected, 1e-5) << from << " to " << face;
    }
  }
}

}  // namespace
}  // namespace orrery
