#include "core/math/mirror.h"
#include "core/techniques/wavefront.h"

namespace orrery {
namespace {

// Whitted, "An improved illumination model for shaded display" (1980): one mirrored and one refracted ray a
// specular surface.
template <class T>
class Whitted final : public Wavefront<T> {
 public:
  using Wavefront<T>::Wavefront;

 private:
  using N = Lanes<T>;
  using Kind = typename Wavefront<T>::Kind;

  void scatter(const Groups& groups) override {
    const auto& v = *this->vertices_;
    for (const int i : groups) {
      const auto mine = this->specular_lanes(i);
      const Vec3<N> reflected =
          mirrored(v.paths->rays.direction.at(i), v.surface.normal.at(i), v.surface.geometric.at(i));
      this->spawn(Kind::reflected, i, mine, reflected, v.specular.reflectance.at(i));
      this->spawn(Kind::refracted, i, mine, v.specular.refracted.at(i), v.specular.transmittance.at(i));
    }
  }
};

}  // namespace

TechniqueType whitted_type() {
  return {"whitted", "Mirrored and refracted rays as well (Whitted 1980).", true,
          make_tracer_of<Whitted, float>, make_tracer_of<Whitted, double>};
}

}  // namespace orrery
