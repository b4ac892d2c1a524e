#include "core/stability/corner_ray.h"
#include "core/stability/row.h"

namespace orrery {
namespace {

// Intersects slabs by min and max, without padding (Kay, Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH
// 1986).
bool textbook_enters(const BoxTest<double>& b) {
  double near = 0, far = std::numeric_limits<double>::infinity();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double inverse = 1 / b.direction[axis];
    const double t0 = (b.lo[axis] - b.origin[axis]) * inverse, t1 = (b.hi[axis] - b.origin[axis]) * inverse;
    near = std::max(near, std::min(t0, t1));
    far = std::min(far, std::max(t0, t1));
  }
  return near <= far;
}

StabilityFigures measure() {
  constexpr int kRays = 100'000;
  SplitMix random(7);
  int known = 0, ours = 0;
  for (int i = 0; i < kRays; ++i) {
    const BoxTest<double> b = ray_through_a_corner(random, std::ldexp(1.0, random.below(21) - 52));
    known += !textbook_enters(b);
    ours += !b.enters_it();
  }
  return {100.0 * known / kRays, 100.0 * ours / kRays};
}

}  // namespace

StabilityRow slab_corners_row() {
  return {
      "A27",
      "Corners of boxes",
      "rays exactly through corners of flat boxes with coordinates up to 1e6 m, in double: rays that miss",
      "%",
      "slab test by min and max (Kay, Kajiya 1986)",
      10,
      "far distances enlarged by 4 machine epsilons, and comparisons that ignore NaN (Ize 2013)",
      0,
      measure};
}

}  // namespace orrery
