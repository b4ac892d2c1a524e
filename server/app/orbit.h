#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/plan/request.h"
#include "server/app/frame.h"

namespace orrery {

inline constexpr double kLongestStep_s = 3600;  // of the motion, from frame to frame

// A turn of the camera about a scene, while what moves in it moves, again and again.
struct OrbitPath {
  RenderRequest first;      // frame
  TimeSpan motion;          // of the scene
  double step_degrees = 3;  // of azimuth, from frame to frame
  double step_seconds = 0;  // of the motion, likewise

  RenderRequest at(std::int64_t frame) const {
    RenderRequest request = first;
    request.orbit.azimuth_degrees += static_cast<double>(frame) * step_degrees;
    request.time = motion.moment_of_loop(*first.time + static_cast<double>(frame) * step_seconds);
    return request;
  }
};

// One turn in so many frames, and what is left of the scene's motion.
inline OrbitPath full_turn(const Scene& scene, const RenderRequest& first, int frames) {
  OrbitPath path{first, scene.motion, 360.0 / frames};
  path.first.time = scene.motion.moment(first.time.value_or(scene.render.time));
  path.step_seconds = (scene.motion.last - *path.first.time) / frames;
  return path;
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
