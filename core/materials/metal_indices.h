#pragma once

#include <array>
#include <string_view>

#include "core/math/vec3.h"

namespace orrery {

// Measured indices of refraction and extinction coefficients of metals at 650, 550 and 450 nm, used as red,
// green and blue. Values are interpolated between the tabulated wavelengths. Gold, silver and copper: Johnson
// and Christy, "Optical constants of the noble metals", Phys. Rev. B 6 (1972). Iron: the same authors,
// "Optical constants of transition metals", Phys. Rev. B 9 (1974). Aluminium: Rakic, "Algorithm for the
// determination of intrinsic optical constants of metal films", Applied Optics 34 (1995).
struct MetalIndices {
  std::string_view name;
  Vec3d n, k;
};
inline constexpr std::size_t kMetals = 5;
inline const std::array<MetalIndices, kMetals>& metal_indices() {
  static const std::array<MetalIndices, kMetals> metals{{
      {"gold", {0.156, 0.424, 1.383}, {3.602, 2.472, 1.915}},
      {"silver", {0.052, 0.060, 0.040}, {4.409, 3.597, 2.648}},
      {"copper", {0.238, 1.007, 1.240}, {3.626, 2.582, 2.393}},
      {"iron", {2.911, 2.950, 2.584}, {3.089, 2.932, 2.767}},
      {"aluminium", {1.558, 1.015, 0.633}, {7.712, 6.627, 5.454}},
  }};
  return metals;
}

}  // namespace orrery
