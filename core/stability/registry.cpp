#include "core/stability/registry.h"

#include <array>
#include <stdexcept>
#include <string_view>

namespace orrery {

// One line per row. NAME.cpp defines NAME_row().
// clang-format off
#define ORRERY_STABILITY(add) \
  add(far_sphere)             \
  add(cylinder_roots)         \
  add(watertight_edges)       \
  add(small_triangle)         \
  add(sliver)                 \
  add(self_hit)               \
  add(offset_step)            \
  add(far_scene)              \
  add(slab_corners)           \
  add(tangent_frame)          \
  add(unit_vector)            \
  add(unit_random)            \
  add(accumulation)           \
  add(torus_quartic)          \
  add(phong_blinn)            \
  add(area_light)             \
  add(leaving_glass)          \
  add(schlick_inside)         \
  add(schlick)                \
  add(threshold)              \
  add(rare_feature)           \
  add(halves)                 \
  add(upper_mean)             \
  add(second_pair)            \
  add(terminator)
// clang-format on

#define ORRERY_DECLARE(name) StabilityRow name##_row();
#define ORRERY_ENTRY(name) name##_row(),

ORRERY_STABILITY(ORRERY_DECLARE)

std::span<const StabilityRow> stability_rows() {
  static const std::array rows{ORRERY_STABILITY(ORRERY_ENTRY)};
  return rows;
}

const StabilityRow& stability_row(const char* id) {
  for (const StabilityRow& row : stability_rows())
    if (row.id == std::string_view(id)) return row;
  throw std::out_of_range(id);
}

std::vector<StabilityResult> measure_stability() {
  std::vector<StabilityResult> results;
  for (const StabilityRow& row : stability_rows()) results.push_back({row, row.measure()});
  return results;
}

}  // namespace orrery
