#include "core/math/mirror.h"
#include "core/techniques/specular_tree.h"

namespace orrery {
namespace {

// Whitted, "An improved illumination model for shaded display" (1980): one mirrored and one refracted ray per
// specular surface.
template <class T>
class Whitted final : public SpecularTree<T> {
 public:
  using SpecularTree<T>::SpecularTree;

 private:
  using N = Lanes<T>;
  using Kind = typename SpecularTree<T>::Kind;

  void scatter(const LaneGroups& groups) override {
    const auto& v = *this->vertices_;
    const auto& specular = this->specular_;
    for (const int i : groups) {
      const auto mine = this->specular_lanes(i);
      const Vec3<N> reflected =
          mirrored(v.paths->rays.direction.at(i), v.surface.normal.at(i), v.surface.geometric.at(i));
      this->follow(Kind::reflected, i, mine, reflected, specular.reflectance.at(i));
      this->follow(Kind::refracted, i, mine, specular.refracted.at(i), specular.transmittance.at(i));
    }
  }
};

}  // namespace

TechniqueType whitted_type() {
  return {.name = "whitted",
          .summary = "Ray casting plus reflected and refracted rays (Whitted 1980).",
          .origin = "Whitted 1980",
          .max_depth = 5,
          .secondary_rays = true,
          .not_followed = {"soft shadows", "interreflection", "caustics"},
          .make_float = make_tracer_of<Whitted, float>,
          .make_double = make_tracer_of<Whitted, double>};
}

}  // namespace orrery
