#include "server/app/picture_key.h"

#include <charconv>

#include "core/base/hash.h"
#include "core/base/version.h"

namespace orrery {
namespace {

// The shortest decimal that reads back to the same number; -0 is 0.
std::string text_of(double number) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, number + 0.0).ptr;
  return {buffer, end};
}

}  // namespace

std::string canonical_request(const Scene& scene, const RenderRequest& request) {
  const RenderSettings& own = scene.render;
  std::string text;
  const auto add = [&](const char* name, const std::string& value) {
    text += std::string(name) + "=" + value + ";";
  };
  add("width", std::to_string(request.width.value_or(own.width)));
  add("height", std::to_string(request.height.value_or(own.height)));
  add("samples", std::to_string(request.samples.value_or(own.samples)));
  add("max_depth", std::to_string(request.max_depth.value_or(own.max_depth)));
  add("technique", request.technique.value_or(own.technique));
  add("precision", std::to_string(static_cast<int>(request.precision.value_or(own.precision))));
  add("min_contribution", text_of(request.min_contribution.value_or(own.min_contribution)));
  for (const auto& [name, own_value] : scene.camera->parameters())
    add(name, text_of(std::string_view(name) == "fov_degrees" ? request.fov_degrees.value_or(own_value)
                                                              : own_value));
  add("seed", std::to_string(request.seed.value_or(own.seed)));
  add("time", text_of(scene.motion.moment(request.time.value_or(own.time))));
  add("azimuth", text_of(request.orbit.azimuth_degrees));
  add("elevation", text_of(request.orbit.elevation_degrees));
  add("distance", text_of(request.orbit.distance));
  const Vec3d& pan = request.orbit.pan;
  add("pan", text_of(pan.x) + "," + text_of(pan.y) + "," + text_of(pan.z));
  return text;
}

std::string canonical_orbit(const Scene& scene, const OrbitPath& path, int frames) {
  return scene.id + " " + canonical_request(scene, path.first) + " " + std::to_string(frames) + " " +
         text_of(path.step_degrees) + " " + text_of(path.step_seconds);
}

std::string etag_of(const Scene& scene, const RenderRequest& request) {
  const std::string all = scene.id + "\n" + canonical_request(scene, request) + "\n" + std::string(kVersion);
  return "\"" + sha256_hex(all).substr(0, 32) + "\"";
}

}  // namespace orrery
