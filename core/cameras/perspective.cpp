#include "core/cameras/camera_of.h"
#include "core/math/angles.h"
#include "core/params/params.h"

namespace orrery {
namespace {

class Perspective final : public CameraOf<Perspective> {
 public:
  explicit Perspective(double fov_degrees) : fov_degrees_(fov_degrees) {}

  const char* type() const override { return "perspective"; }
  std::vector<Parameter> parameters() const override { return {{"fov_degrees", fov_degrees_}}; }
  bool parallel() const override { return false; }
  double half_extent(double) const override { return tangent_degrees(fov_degrees_ / 2); }
  std::unique_ptr<Camera> with_fov(double degrees) const override {
    return std::make_unique<Perspective>(degrees);
  }

  template <class N>
  Ray<N> ray(const CameraView<N>& view, const N& sx, const N& sy) const {
    const Vec3<N> offset = view.right * sx + view.up * sy;
    return {view.eye, normalize(view.forward + offset)};
  }

 private:
  double fov_degrees_;  // vertical field of view
};

std::unique_ptr<Camera> read(Params& p) {
  return std::make_unique<Perspective>(
      p.number("fov_degrees", "Vertical field of view in degrees, for any aspect ratio.",
               {.min = 0, .max = 180, .exclusive_min = true, .exclusive_max = true}, 45.0));
}

}  // namespace

CameraType perspective_type() {
  return {"perspective", "Perspective projection: all rays start at one point.", read};
}

}  // namespace orrery
