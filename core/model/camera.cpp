#include "core/model/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/angles.h"

namespace orrery {

CameraFrame frame_at(const Camera& camera, const Orbit& orbit) {
  const Vec3d pole = safe_normalize(camera.up);
  const Vec3d offset = camera.eye - camera.look_at;
  const double own_distance = length(offset);
  // The own direction, split along the pole and across it.
  const Vec3d direction = safe_normalize(offset);
  const double own_sine = dot(direction, pole);
  const Vec3d across = direction - pole * own_sine;
  const double own_cosine = length(across);
  const Vec3d own_out = across / own_cosine, own_right = cross(pole, own_out);

  const SineCosine turn = sine_cosine_degrees(orbit.azimuth_degrees);
  const Vec3d out = own_out * turn.cosine + own_right * turn.sine;
  const Vec3d right = own_right * turn.cosine - own_out * turn.sine;
  const SineCosine lift = sine_cosine_degrees(std::clamp(orbit.elevation_degrees, -180.0, 180.0));
  double cosine = own_cosine * lift.cosine - own_sine * lift.sine;
  double sine = own_sine * lift.cosine + own_cosine * lift.sine;
  if (cosine < 0 || std::abs(orbit.elevation_degrees) >= 180) {
    cosine = 0;
    sine = orbit.elevation_degrees > 0 ? 1 : -1;
  }

  CameraFrame frame;
  frame.back = out * cosine + pole * sine;
  frame.up = pole * cosine - out * sine;
  frame.right = right;
  frame.distance = own_distance * orbit.distance;
  frame.eye = camera.look_at + frame.back * frame.distance;
  const bool own_place = turn.sine == 0 && turn.cosine == 1 && lift.sine == 0 && orbit.distance == 1;
  if (own_place) frame.eye = camera.eye;
  frame.eye = frame.eye + orbit.pan;
  frame.projection = camera.projection;
  frame.half_extent = camera.projection == Projection::perspective ? tangent_degrees(camera.fov_degrees / 2)
                                                                   : camera.height / 2 * orbit.distance;
  return frame;
}

namespace {

struct TilePixels {
  Array<float> x, y;
};

const TilePixels& tile_pixels() {
  static const TilePixels pixels = [] {
    TilePixels p;
    for (int slot = 0; slot < kBatch; ++slot) {
      p.x[slot] = static_cast<float>(tile_pixel(slot).x);
      p.y[slot] = static_cast<float>(tile_pixel(slot).y);
    }
    return p;
  }();
  return pixels;
}

}  // namespace

template <class T>
void generate_rays(const CameraFrame& frame, int width, int height, int x0, int y0,
                   const TileSamples& samples, RayBatch<T>& out) {
  using N = Lanes<T>;
  const T scale = static_cast<T>(frame.half_extent / height);  // half a pixel, in x and y alike
  const Vec3<N> right(Vec3<T>(frame.right)), up(Vec3<T>(frame.up)), forward(Vec3<T>(-frame.back));
  const Vec3<N> eye(Vec3<T>(frame.eye));
  const bool perspective = frame.projection == Projection::perspective;
  const TilePixels& pixels = tile_pixels();
  const auto lanes = [](const Array<float>& a, int i) { return N(&a[i], stdx::element_aligned); };
  for (int i = 0; i < kBatch; i += kWidth<T>) {
    const N px = lanes(pixels.x, i) + T(x0), py = lanes(pixels.y, i) + T(y0);
    // Exact for pixel centres, so that a picture mirrored about its middle is mirrored to the bit.
    const N sx = (T(2) * (px + lanes(samples.u, i)) - T(width)) * scale;
    const N sy = (T(height) - T(2) * (py + lanes(samples.v, i))) * scale;
    const Vec3<N> offset = right * sx + up * sy;
    out.origin.put(i, perspective ? eye : eye + offset);
    out.direction.put(i, perspective ? normalize(forward + offset) : forward);
    const auto shown = px < N(T(width)) && py < N(T(height));
    out.t_max.put(i, select(shown, N(std::numeric_limits<T>::infinity()), N(T(-1))));
  }
  out.count = kBatch;
}

template void generate_rays(const CameraFrame&, int, int, int, int, const TileSamples&, RayBatch<float>&);
template void generate_rays(const CameraFrame&, int, int, int, int, const TileSamples&, RayBatch<double>&);

}  // namespace orrery
