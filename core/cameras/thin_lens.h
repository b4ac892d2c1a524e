#pragma once

#include "core/math/elementary.h"
#include "core/model/camera.h"
#include "core/model/draws.h"

namespace orrery {

// Has camera rays leave from points of a thin lens about the eye, toward where they cross the plane that is
// sharp (Cook, Porter, Carpenter, "Distributed Ray Tracing", SIGGRAPH 1984). The points are spread evenly
// over the lens's disk. REQUIRES: the frame's aperture is not 0.
template <class T>
void apply_thin_lens(const CameraFrame& frame, const Draws& draws, SampleSet set, RayBatch<T>& rays) {
  using N = Lanes<T>;
  using std::sqrt;
  const Vec3<N> right(Vec3<T>(frame.right * frame.aperture_radius)),
      up(Vec3<T>(frame.up * frame.aperture_radius)), forward(Vec3<T>(-frame.back));
  const N focus(static_cast<T>(frame.focus_distance));
  const IndexLanes<T> lane([](int i) { return static_cast<IndexOf<T>>(i); });
  for (int i = 0; i < kBatch; i += kWidth<T>) {
    const auto [u, v] = draws.two<T>(set, 0, lane + static_cast<IndexOf<T>>(i));
    const N radius = sqrt(u);
    const auto [sine, cosine] = sine_cosine_turns(v);
    const Vec3<N> on_lens = right * (radius * cosine) + up * (radius * sine),
                  direction = rays.direction.at(i);
    const Vec3<N> to_sharp = direction * (focus / dot(direction, forward));
    rays.origin.put(i, rays.origin.at(i) + on_lens);
    rays.direction.put(i, normalize(to_sharp - on_lens));
  }
}

}  // namespace orrery
