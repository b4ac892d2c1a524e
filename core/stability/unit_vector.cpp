#include <algorithm>
#include <cmath>

#include "core/math/vec3.h"
#include "core/stability/row.h"

namespace orrery {
namespace {

double error_of(const Vec3f& unit) { return std::abs(length(Vec3d(unit)) - 1); }

StabilityFigures measure() {
  StabilityFigures worst{0, 0};
  for (const float size : {1.5e-23f, 1e-10f, 1.0f, 1e10f, 1e20f}) {
    const Vec3f v(size, size, 0);
    const float root = std::sqrt(dot(v, v));
    const Vec3f by_root = root > 0 ? v / root : Vec3f();
    worst.known = std::max(worst.known, error_of(by_root));
    worst.ours = std::max(worst.ours, error_of(safe_normalize(v)));
  }
  return worst;
}

}  // namespace

StabilityRow unit_vector_row() {
  return {"A31",
          "Unit vector",
          "normalization of vectors of length 1e-23 to 1e20, in float: largest error of the length",
          "1",
          "division by the root of the sum of squares, which underflows or overflows",
          1,
          "largest component scaled to 1 first",
          2.4e-7,
          measure};
}

}  // namespace orrery
