#include <algorithm>
#include <cmath>

#include "core/materials/refractive.h"
#include "core/stability/row.h"

namespace orrery {
namespace {

double degrees_of(double sine) { return 360 * direction_turns(std::sqrt((1 - sine) * (1 + sine)), sine); }

// Rays inside glass of index 1.5 reach its surface at angles of incidence from 1 to 41 degrees.
StabilityFigures measure() {
  constexpr double kIndex = 1.5;
  const Refractive<double> glass{kIndex, 0.04, 1, Vec3d(0)};
  StabilityFigures worst{0, 0};
  for (double angle = 1; angle < 41.5; ++angle) {
    const auto [sine, cosine] = sine_cosine_turns(angle / 360);
    const double exact = degrees_of(sine * kIndex);  // Snell's law
    const Vec3d refracted = glass.split(Vec3d(sine, 0, -cosine), Vec3d(0, 0, 1), true).refracted;
    worst.known = std::max(worst.known, std::abs(degrees_of(sine / kIndex) - exact));
    worst.ours = std::max(worst.ours, std::abs(360 * direction_turns(-refracted.z, refracted.x) - exact));
  }
  return worst;
}

}  // namespace

StabilityRow leaving_glass_row() {
  return {"D4",
          "Rays that leave glass",
          "directions of rays that leave glass of index 1.5, incident at up to 41 degrees: largest error",
          "degrees",
          "index ratio of entering rays, also used for leaving rays",
          50,
          "Snell's law with the index ratio for the side that the ray comes from",
          1e-10,
          measure};
}

}  // namespace orrery
