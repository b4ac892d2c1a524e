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

TracerPtr<float> make_raycast(const World<float>& world, const Plan& plan) {
  return std::make_unique<Raycast<float>>(world, plan);
}
TracerPtr<double> make_raycast(const World<double>& world, const Plan& plan) {
  return std::make_unique<Raycast<double>>(world, plan);
}

}  // namespace orrery
