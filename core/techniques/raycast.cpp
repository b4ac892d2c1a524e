#include "core/math/mirror.h"
#include "core/techniques/specular_tree.h"

namespace orrery {
namespace {

// Appel, "Some techniques for shading machine renderings of solids" (1968): visible surfaces and shadows.
// Specular surfaces show ambient light instead of reflections.
template <class T>
class Raycast final : public SpecularTree<T> {
 public:
  using SpecularTree<T>::SpecularTree;

 private:
  using N = Lanes<T>;

  void scatter(const LaneGroups& groups) override {
    const auto& v = *this->vertices_;
    const auto& specular = this->specular_;
    const auto cut = [&](int i, const Vec3<N>& direction, const Vec3<N>& weight) {
      this->cut(i, this->specular_lanes(i) && max_component(weight) > N(T(0)), direction, weight);
    };
    for (const int i : groups) {
      cut(i, mirrored(v.paths->rays.direction.at(i), v.surface.normal.at(i), v.surface.geometric.at(i)),
          specular.reflectance.at(i));
      cut(i, specular.refracted.at(i), specular.transmittance.at(i));
    }
  }
};

}  // namespace

TechniqueType raycast_type() {
  return {.name = "raycast",
          .summary = "Ray casting: camera and shadow rays only (Appel 1968).",
          .origin = "Appel 1968",
          .max_depth = 5,
          .not_followed = {"reflections", "refractions", "soft shadows", "interreflection", "caustics"},
          .make_float = make_tracer_of<Raycast, float>,
          .make_double = make_tracer_of<Raycast, double>};
}

}  // namespace orrery
