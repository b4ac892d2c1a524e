#include <algorithm>
#include <cmath>

#include "core/materials/fresnel.h"
#include "core/math/elementary.h"
#include "core/stability/fresnel_reference.h"
#include "core/stability/row.h"
#include "core/study/svg.h"

namespace orrery {
namespace {

StabilityFigures errors_at(double index, double degrees) {
  const double cosine = sine_cosine_turns(degrees / 360).cosine, eta = 1 / index;
  const double exact = textbook_fresnel(eta, cosine);
  return {std::abs(fresnel_schlick(normal_reflectance(index, 0.0), cosine) - exact),
          std::abs(split_dielectric(eta, cosine).reflectance - exact)};
}

StabilityFigures measure() {
  StabilityFigures worst{0, 0};
  LineChart chart{"schlick",
                  "Schlick's approximation compared with Fresnel's equations",
                  "angle of incidence, degrees",
                  "error of the reflectance",
                  false,
                  false,
                  {}};
  for (const double index : {1.1, 1.333, 1.5, 2.417}) {
    chart.series.push_back({printed("index %g", index), {}});
    for (int i = 0; i <= 180; ++i) {
      const double degrees = 0.5 * i;
      const StabilityFigures errors = errors_at(index, degrees);
      if (i % 2 == 0) chart.series.back().points.push_back({degrees, errors.known});
      worst.known = std::max(worst.known, errors.known);
      worst.ours = std::max(worst.ours, errors.ours);
    }
  }
  worst.chart = std::move(chart);
  return worst;
}

}  // namespace

StabilityRow schlick_row() {
  return {"D7",
          "Schlick's approximation",
          "reflectance of surfaces of index 1.1, 1.333, 1.5 and 2.417 for rays in air: largest error",
          "reflectance",
          "F0 + (1 - F0) (1 - cos)^5 (Schlick 1994)",
          0.2,
          "Fresnel's equations, unless a scene selects Schlick's approximation",
          1e-12,
          measure};
}

}  // namespace orrery
