#pragma once

#include <limits>

#include "core/model/camera.h"

namespace orrery {

// Camera position and axes, as scalars or lanes.
template <class N>
struct CameraView {
  Vec3<N> eye, right, up, forward;
};

// Base of cameras that implement one template:
//   Ray<N> ray(const CameraView<N>& view, const N& sx, const N& sy) const;
// It returns the ray through the image point that is sx to the right of the image centre and sy above the
// centre. The unit of sx and sy is such that half the image height is CameraFrame::half_extent.
template <class Derived>
class CameraOf : public Camera {
 public:
  void generate(const CameraFrame& frame, int width, int height, const TileView& tile,
                const TileSamples& samples, RayBatch<float>& out) const final {
    fill(frame, width, height, tile, samples, out);
  }
  void generate(const CameraFrame& frame, int width, int height, const TileView& tile,
                const TileSamples& samples, RayBatch<double>& out) const final {
    fill(frame, width, height, tile, samples, out);
  }

 private:
  template <class T>
  void fill(const CameraFrame& frame, int width, int height, const TileView& tile, const TileSamples& samples,
            RayBatch<T>& out) const {
    using N = Lanes<T>;
    const T scale = static_cast<T>(frame.half_extent / height);  // half a pixel, in the unit of sx and sy
    const CameraView<N> view{Vec3<N>(Vec3<T>(frame.eye)), Vec3<N>(Vec3<T>(frame.right)),
                             Vec3<N>(Vec3<T>(frame.up)), Vec3<N>(Vec3<T>(-frame.back))};
    const Pixels& pixels = slot_pixels();
    const auto lanes = [](const Array<float>& a, int i) { return N(&a[i], stdx::element_aligned); };
    for (int i = 0; i < kBatch; i += kWidth<T>) {
      const N in_x = lanes(pixels.x, i), in_y = lanes(pixels.y, i);
      const N px = in_x + T(tile.x0), py = in_y + T(tile.y0);
      // Exact for pixel centres, so pixels that mirror each other have coordinates of equal magnitude.
      const N sx = (T(2) * (px + lanes(samples.u, i)) - T(width)) * scale;
      const N sy = (T(height) - T(2) * (py + lanes(samples.v, i))) * scale;
      const Ray<N> ray = static_cast<const Derived*>(this)->ray(view, sx, sy);
      out.origin.put(i, ray.origin);
      out.direction.put(i, ray.direction);
      const auto shown = in_x < N(T(tile.width)) && in_y < N(T(tile.height));
      out.t_max.put(i, select(shown, N(std::numeric_limits<T>::infinity()), N(T(-1))));
    }
    out.count = kBatch;
  }

  struct Pixels {
    Array<float> x, y;
  };
  static const Pixels& slot_pixels() {
    static const Pixels pixels = [] {
      Pixels p;
      for (int slot = 0; slot < kBatch; ++slot) {
        p.x[slot] = static_cast<float>(tile_pixel(slot).x);
        p.y[slot] = static_cast<float>(tile_pixel(slot).y);
      }
      return p;
    }();
    return pixels;
  }
};

}  // namespace orrery
