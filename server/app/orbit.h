#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/plan/request.h"
#include "server/app/frame.h"

namespace orrery {

// A turn of the camera about a scene.
struct OrbitSpec {
  std::shared_ptr<const PreparedScene> scene;
  RenderRequest request;  // of the first frame
  int frames = 120;
  double step_degrees = 3;  // of azimuth, from frame to frame
  double fps = 30;          // at most; 0: as fast as the fastest viewer takes them
  std::string key;          // equal for equal orbits

  RenderRequest request_of(int frame) const {
    RenderRequest turned = request;
    turned.orbit.azimuth_degrees += frame * step_degrees;
    return turned;
  }
};

// One picture of it, shared by all who watch.
struct OrbitFrame {
  int frame = 0;
  Orbit orbit;
  int width = 0, height = 0;
  Frame picture;
};

}  // namespace orrery
