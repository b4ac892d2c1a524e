#include "core/cameras/camera_of.h"
#include "core/params/params.h"

namespace orrery {
namespace {

class Orthographic final : public CameraOf<Orthographic> {
 public:
  explicit Orthographic(double height) : height_(height) {}

  const char* type() const override { return "orthographic"; }
  std::vector<Parameter> parameters() const override { return {{"height", height_}}; }
  bool parallel() const override { return true; }
  double half_extent(double distance) const override { return height_ / 2 * distance; }

  template <class N>
  Ray<N> ray(const CameraView<N>& view, const N& sx, const N& sy) const {
    const Vec3<N> offset = view.right * sx + view.up * sy;
    return {view.eye + offset, view.forward};
  }

 private:
  double height_;  // height of the view, metres
};

std::unique_ptr<Camera> read(Params& p) {
  return std::make_unique<Orthographic>(p.positive("height", "Height of the view, in metres."));
}

}  // namespace

CameraType orthographic_type() { return {"orthographic", "Orthographic projection: parallel rays.", read}; }

}  // namespace orrery
