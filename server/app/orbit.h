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
#include "server/app/frame.h"

namespace orrery {

inline constexpr double kLongestStep_s = 3600;  // of the motion, from frame to frame

// A turn of the camera about a scene, while what moves in it moves, again and again.
struct OrbitPath {
  RenderRequest first;      // frame; every option is given, but with a budget only what it does not choose
  TimeSpan motion;          // of the scene
  double step_degrees = 3;  // of azimuth, from frame to frame
  double step_seconds = 0;  // of the motion, likewise

  RenderRequest at(std::int64_t frame) const {
    RenderRequest request = first;
    request.azimuth_degrees = azimuth_degrees(frame);
    request.time = motion.moment_of_loop(*first.time + static_cast<double>(frame) * step_seconds);
    return request;
  }
  double azimuth_degrees(std::int64_t frame) const {
    return *first.azimuth_degrees + static_cast<double>(frame) * step_degrees;
  }
  // Every other frame is made by the settings that made the first one. Errors stay in their space.
  void go_on_as(const RenderSettings& settings) {
    const std::optional<Space> space = first.space;
    static_cast<RenderSettings&>(first) = settings;
    first.space = space;
  }
};

// One turn in so many frames, and what is left of the scene's motion.
inline OrbitPath full_turn(const Scene& scene, const RenderRequest& first, int frames) {
  OrbitPath path{first, scene.motion, 360.0 / frames};
  const RenderSettings all = resolve(scene, first);
  if (!has_budget(first)) static_cast<RenderSettings&>(path.first) = all;
  path.first.azimuth_degrees = all.azimuth_degrees;
  path.first.time = all.time;
  path.step_seconds = (scene.motion.last - *path.first.time) / frames;
  return path;
}

// Throws InputError, with the pointer of the step, if the last frame is turned farther than one picture may
// be.
inline void require_range(const OrbitPath& path, int frames, std::string_view step_pointer) {
  const double azimuth = path.azimuth_degrees(frames - 1);
  if (!(std::abs(azimuth) <= kMaxOrbitDegrees))
    throw InputError(std::string(step_pointer), "expected a last frame at no more than " +
                                                    number_text(kMaxOrbitDegrees) +
                                                    " degrees of azimuth, got " + number_text(azimuth));
}

// How an orbit is shown to those who watch it.
struct OrbitSpec {
  std::shared_ptr<const PreparedScene> scene;
  OrbitPath path;
  int frames = 120;
  double fps = 30;     // at most; 0: as fast as the fastest viewer takes them
  std::string key;     // equal for equal orbits
  std::string client;  // who asked for it first
};

// One picture of it, shared by all who watch.
struct OrbitFrame {
  int frame = 0;
  Orbit orbit;
  double time = 0;  // of the motion, seconds
  int width = 0, height = 0;
  Frame picture;
};

}  // namespace orrery
