#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace orrery {

// Former names of JSON keys, which stay valid as aliases. Schema, help and catalog list the
// present names only. CHANGELOG.md has the same list.
struct FormerName {
  std::string_view present, former;
};
inline constexpr std::array kFormerNames{
    FormerName{"max_error", "error"},
    FormerName{"time_limit_seconds", "seconds"},
    FormerName{"error_metric", "space"},
    FormerName{"on_budget_miss", "on_miss"},
    FormerName{"path_reuse", "reuse"},
    FormerName{"occluder_prediction", "prediction"},
    FormerName{"ray_sorting", "reorder"},
    FormerName{"direction_to_light", "from"},
    FormerName{"clamp_to_one", "limited"},
    FormerName{"edge_u", "a"},
    FormerName{"edge_v", "b"},
    FormerName{"diffuse_color", "cd"},
    FormerName{"specular_color", "cs"},
    FormerName{"aperture_blades", "blades"},
};

// Returns the former name of a present one, or "" if it has none.
constexpr std::string_view former_name(std::string_view present) {
  const auto found = std::find_if(kFormerNames.begin(), kFormerNames.end(),
                                  [&](const FormerName& name) { return name.present == present; });
  return found == kFormerNames.end() ? std::string_view() : found->former;
}

}  // namespace orrery
