#pragma once

#include <array>

#include "core/math/angles.h"
#include "core/math/elementary.h"
#include "core/model/camera.h"
#include "core/model/draws.h"

namespace orrery {

// Uniform sampling of a lens aperture of radius 1: a disk or a regular polygon.
template <class T>
class LensShape {
 public:
  using N = Lanes<T>;
  struct Point {
    N right, up;
  };

  explicit LensShape(const LensBlades& blades) : blades_(blades.count) {
    for (int k = 0; k <= blades_ && blades_ > 0; ++k) {
      const SineCosine corner = sine_cosine_degrees(blades.degrees + 360.0 * k / blades_);
      right_[static_cast<std::size_t>(k)] = static_cast<T>(corner.cosine);
      up_[static_cast<std::size_t>(k)] = static_cast<T>(corner.sine);
    }
  }

  // Returns the point for uniform u and v in [0, 1). In a polygon, u selects the triangle between the centre
  // and one side, and the distance from the centre. v is the position along the side.
  [[gnu::always_inline]] Point at(const SamplePoint<N>& sample) const {
    using std::sqrt;
    if (blades_ == 0) {
      const N radius = sqrt(sample.u);
      const auto [sine, cosine] = sine_cosine_turns(sample.v);
      return {radius * cosine, radius * sine};
    }
    const N place = sample.u * N(T(blades_));
    const auto side = [&](int lane) {
      return std::min(static_cast<std::size_t>(place[static_cast<std::size_t>(lane)]),
                      static_cast<std::size_t>(blades_ - 1));
    };
    const auto between = [&](const std::array<T, kMaxBlades + 1>& corner) {
      const N from([&](int lane) { return corner[side(lane)]; }),
          to([&](int lane) { return corner[side(lane) + 1]; });
      return from + (to - from) * sample.v;
    };
    const N left([&](int lane) { return T(side(lane)); }), outward = sqrt(N(place - left));
    return {outward * between(right_), outward * between(up_)};
  }

 private:
  int blades_;
  std::array<T, kMaxBlades + 1> right_, up_;  // corner coordinates, the first corner repeated at the end
};

// Moves the origin of each camera ray to a point of a thin lens. Aims the ray at the point where the original
// ray crosses the plane of focus (Cook, Porter, Carpenter, "Distributed Ray Tracing", SIGGRAPH 1984).
// REQUIRES: the camera is not an all-around camera.
template <class T>
void apply_thin_lens(const CameraFrame& frame, const Draws& draws, SampleSet set, RayBatch<T>& rays) {
  using N = Lanes<T>;
  const LensShape<T> shape(frame.blades);
  const Vec3<N> right(Vec3<T>(frame.right * frame.aperture_radius)),
      up(Vec3<T>(frame.up * frame.aperture_radius)), forward(Vec3<T>(-frame.back));
  const N focus(static_cast<T>(frame.focus_distance));
  const IndexLanes<T> lane([](int i) { return static_cast<IndexOf<T>>(i); });
  for (int i = 0; i < kBatch; i += kWidth<T>) {
    const auto point = shape.at(draws.two<T>(set, 0, lane + static_cast<IndexOf<T>>(i)));
    const Vec3<N> on_lens = right * point.right + up * point.up, direction = rays.direction.at(i);
    const Vec3<N> to_sharp = direction * (focus / dot(direction, forward));
    rays.origin.put(i, rays.origin.at(i) + on_lens);
    rays.direction.put(i, normalize(to_sharp - on_lens));
  }
}

}  // namespace orrery
