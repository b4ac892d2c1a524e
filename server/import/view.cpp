#include "server/import/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/meshes/text.h"
#include "core/params/params.h"
#include "core/plan/limits.h"

namespace orrery {

bool sees_mirrored(const ImportCamera& camera) {
  const auto axis = [&](const Vec3d& v) { return safe_normalize(camera.map.vector(v)); };
  return dot(cross(axis(camera.forward), axis(camera.up)), axis(camera.right)) < 0;
}

void set_camera(SceneWriter& scene, const ImportCamera& camera) {
  const Vec3d forward = camera.map.vector(camera.forward);
  const double unit = length(forward);
  if (!(unit > 0 && std::isfinite(unit)))
    scene.refuse("camera must have a finite transformation with an inverse");
  const bool keeps_shape = camera.type == "orthographic" ? instance_parts(camera.map).has_value()
                                                         : uniform_scale(camera.map).has_value();
  if (!keeps_shape) scene.notes().add("camera is drawn without the shear of its transformation");
  const bool has_lens = camera.lens_radius > 0;
  const double distance = has_lens ? camera.focus_distance : camera.target_distance;
  SceneJson json{{"type", camera.type},
                 {"eye", scene.point(camera.map.origin)},
                 {"look_at", scene.point(camera.map.origin + forward * std::clamp(distance, 1e-3, 1e6))},
                 {"up", scene.direction(camera.map.vector(camera.up))}};
  if (camera.type == "perspective")
    json["fov_degrees"] = 2 * std::atan(camera.half_height) * 180 / std::numbers::pi;
  if (camera.type == "orthographic")
    json["height"] = 2 * camera.half_height * length(camera.map.vector(camera.up));
  if (has_lens && camera.type != "panorama") {
    json["aperture_radius"] = camera.lens_radius * unit;
    json["focus_distance"] = camera.focus_distance * unit;
  }
  scene.set("camera", std::move(json));
}

void set_image_size(SceneWriter& scene, double width, double height) {
  const double factor = std::min({1.0, kMaxImageSide / width, kMaxImageSide / height});
  if (factor < 1)
    scene.notes().add("image of " + number_text(width) + " x " + number_text(height) +
                      " pixels is reduced to " + std::to_string(kMaxImageSide) + " at most");
  const auto side = [&](double pixels) {
    return std::max(1, static_cast<int>(std::lround(pixels * factor)));
  };
  scene.set("image", {{"width", side(width)}, {"height", side(height)}});
}

void set_render_options(SceneWriter& scene, double samples, double bounces, const std::string& filter) {
  SceneJson render{{"technique", "path"},
                   {"samples", static_cast<int>(std::clamp(samples, 1.0, double{kMaxSamples}))},
                   {"max_depth", static_cast<int>(std::clamp(bounces, 0.0, double{kMaxDepth}))}};
  constexpr std::array<std::string_view, 4> kFilters{"gaussian", "mitchell", "lanczos", "box"};
  if (std::find(kFilters.begin(), kFilters.end(), filter) == kFilters.end())
    scene.notes().add("pixel filter " + excerpt(filter) + " is replaced by a box");
  else if (filter != "box")
    render["filter"] = filter;
  scene.set("render", std::move(render));
}

}  // namespace orrery
