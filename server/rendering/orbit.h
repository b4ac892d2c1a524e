#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/params/params.h"
#include "core/plan/limits.h"
#include "core/plan/options.h"
#include "core/plan/request.h"
#include "server/cache/stored_scene.h"
#include "server/rendering/frame.h"

namespace orrery {

inline constexpr double kLongestStep_s = 3600;  // maximum motion time per frame

// Camera orbit around a scene whose motion plays in a loop.
struct OrbitPath {
  RenderRequest first;      // first frame; all options are set except those that its budget chooses
  TimeSpan motion;          // time span of the scene's motion
  double step_degrees = 3;  // azimuth per frame
  double step_seconds = 0;  // motion time per frame

  RenderRequest at(std::int64_t frame) const {
    RenderRequest request = first;
    request.azimuth_degrees = azimuth_degrees(frame);
    request.time = motion.moment_of_loop(*first.time + static_cast<double>(frame) * step_seconds);
    return request;
  }
  double azimuth_degrees(std::int64_t frame) const {
    return *first.azimuth_degrees + static_cast<double>(frame) * step_degrees;
  }
  // Uses `settings`, those of the rendered first frame, for all later frames. Keeps the error space.
  void continue_with(const RenderSettings& settings) {
    const std::optional<Space> space = first.space;
    static_cast<RenderSettings&>(first) = settings;
    first.space = space;
  }
};

// Returns a full turn in `frames` frames. Meanwhile, the motion of the scene plays from the time of `first`
// to its end.
inline OrbitPath full_turn(const Scene& scene, const RenderRequest& first, int frames) {
  OrbitPath path{first, scene.motion, 360.0 / frames};
  const RenderSettings all = resolve(scene, first);
  if (!has_budget(first)) static_cast<RenderSettings&>(path.first) = all;
  path.first.azimuth_degrees = all.azimuth_degrees;
  path.first.time = all.time;
  path.step_seconds = (scene.motion.last - *path.first.time) / frames;
  return path;
}

// Throws InputError at `step_pointer` if the azimuth of the last frame exceeds the limit of an image.
inline void require_range(const OrbitPath& path, int frames, std::string_view step_pointer) {
  const double azimuth = path.azimuth_degrees(frames - 1);
  if (!(std::abs(azimuth) <= kMaxOrbitDegrees))
    throw InputError(std::string(step_pointer),
                     "azimuth of the last frame must be from -" + number_text(kMaxOrbitDegrees) + " to " +
                         number_text(kMaxOrbitDegrees) + " degrees (got " + number_text(azimuth) + ")");
}

// Parameters of an orbit stream.
struct OrbitSpec {
  std::shared_ptr<const StoredScene> scene;
  OrbitPath path;
  int frames = 120;
  double fps = 30;     // maximum frames per second; 0: as fast as the fastest viewer reads
  std::string key;     // equal for equal orbits
  std::string client;  // client that requested it first
};

// Frame of an orbit, shared by all viewers.
struct OrbitFrame {
  int frame = 0;
  Orbit orbit;
  double time = 0;  // motion time, seconds
  int width = 0, height = 0;
  Frame picture;
};

}  // namespace orrery
