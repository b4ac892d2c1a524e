#include <numbers>

#include "core/cameras/camera_of.h"
#include "core/math/elementary.h"
#include "core/params/params.h"

namespace orrery {
namespace {

// Equirectangular camera: rows are evenly spaced latitudes, columns evenly spaced longitudes. The image
// height covers 180 degrees. An image twice as wide as high shows every direction once. A wider image repeats
// directions.
class Panorama final : public CameraOf<Panorama> {
 public:
  const char* type() const override { return "panorama"; }
  std::vector<Parameter> parameters() const override { return {}; }
  bool parallel() const override { return false; }
  bool all_around() const override { return true; }
  double half_extent(double) const override { return std::numbers::pi / 2; }  // radians

  template <class N>
  Ray<N> ray(const CameraView<N>& view, const N& sx, const N& sy) const {
    const N turns_per_radian(static_cast<ScalarOf<N>>(0.5 / std::numbers::pi));
    const auto [sine, cosine] = sine_cosine_turns(N(sx * turns_per_radian));
    const auto [lift, across] = sine_cosine_turns(N(sy * turns_per_radian));
    const Vec3<N> level = view.forward * cosine + view.right * sine;
    return {view.eye, normalize(level * across + view.up * lift)};
  }
};

std::unique_ptr<Camera> read(Params&) { return std::make_unique<Panorama>(); }

}  // namespace

CameraType panorama_type() {
  return {"panorama",
          "Equirectangular panorama: 360 degrees wide and 180 degrees high, for images of aspect ratio 2:1.",
          read};
}

}  // namespace orrery
