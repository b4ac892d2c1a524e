#include "core/techniques/wavefront.h"

namespace orrery {
namespace {

// Appel, "Some techniques for shading machine renderings of solids" (1968): what the eye sees, and shadows.
// Specular surfaces show ambient light in place of what they would mirror.
template <class T>
class Raycast final : public Wavefront<T> {
 public:
  using Wavefront<T>::Wavefront;

 private:
  void scatter(const Groups& groups) override {
    for (const int i : groups)
      this->cut(i, this->specular_lanes(i),
                this->stage_->specular.reflectance.at(i) + this->stage_->specular.transmittance.at(i));
  }
};

}  // namespace

TechniqueType raycast_type() {
  return {"raycast", "Camera and shadow rays alone (Appel 1968).", false, make_tracer_of<Raycast, float>,
          make_tracer_of<Raycast, double>};
}

}  // namespace orrery
