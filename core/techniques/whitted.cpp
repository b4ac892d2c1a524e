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
    const auto& s = *this->stage_;
    for (const int i : groups) {
      const auto mine = this->specular_lanes(i);
      this->spawn(Kind::reflected, i, mine, mirrored(i), s.specular.reflectance.at(i));
      this->spawn(Kind::refracted, i, mine, s.specular.refracted.at(i), s.specular.transmittance.at(i));
    }
  }

  // About the shading normal, or about the true one where the former would send the ray into the surface.
  Vec3<N> mirrored(int i) const {
    const auto& s = *this->stage_;
    const Vec3<N> d = s.paths->rays.direction.at(i), true_normal = s.surface.geometric.at(i);
    const auto about = [&d](const Vec3<N>& n) { return d - n * (T(2) * dot(d, n)); };
    const Vec3<N> r = about(s.surface.normal.at(i));
    const auto sinks = !(dot(r, true_normal) > N(T(0)));
    if (!any(sinks)) return r;
    const Vec3<N> safe = about(true_normal);
    return {select(sinks, safe.x, r.x), select(sinks, safe.y, r.y), select(sinks, safe.z, r.z)};
  }
};

}  // namespace

TechniqueType whitted_type() {
  return {"whitted", "Mirrored and refracted rays as well (Whitted 1980).", true,
          make_tracer_of<Whitted, float>, make_tracer_of<Whitted, double>};
}

}  // namespace orrery
