#include <algorithm>
#include <cmath>

#include "core/materials/fresnel.h"
#include "core/math/elementary.h"
#include "core/stability/fresnel_reference.h"
#include "core/stability/row.h"

namespace orrery {
namespace {

StabilityFigures measure() {
  constexpr double kIndex = 1.5;
  StabilityFigures worst{0, 0};
  for (int i = 0; i < 900; ++i) {  // tenths of a degree; total reflection from 41.8 degrees
    const double cosine = sine_cosine_turns(i / 3600.0).cosine;
    const double exact = textbook_fresnel(kIndex, cosine);
    worst.known = std::max(worst.known, std::abs(fresnel_schlick(0.04, cosine) - exact));
    worst.ours = std::max(worst.ours, std::abs(split_dielectric(kIndex, cosine).reflectance - exact));
  }
  return worst;
}

}  // namespace

StabilityRow schlick_inside_row() {
  return {"D6",
          "Schlick's cosine inside glass",
          "reflectance of glass of index 1.5 for rays inside it: largest error",
          "reflectance",
          "Schlick's approximation with the cosine of incidence, even inside glass",
          0.9,
          "Fresnel's equations; Schlick's approximation, if a scene selects it, uses the cosine in air",
          1e-12,
          measure};
}

}  // namespace orrery
