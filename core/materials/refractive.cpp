#include "core/materials/fresnel.h"
#include "core/materials/material_set.h"
#include "core/math/elementary.h"
#include "core/params/params.h"

namespace orrery {
namespace {

template <class N>
struct Refractive {
  N ior;                // index inside over index outside
  N f0;                 // reflectance along the normal
  N exact;              // 1: Fresnel's equations, 0: Schlick's approximation
  Vec3<N> log2_filter;  // of what remains of light after one metre inside

  static Refractive<double> read(Params& p) {
    const double ior = p.number("ior", "Index of refraction inside over outside.", {.min = 0.01, .max = 100});
    const bool exact =
        p.choice("fresnel", "How the reflectance is computed.", {"schlick", "exact"}, "schlick") == "exact";
    const Vec3d filter = p.color("filter", "What remains of light after one metre inside.", Vec3d(1), 1);
    const auto log2_of = [](double x) {
      return x < std::numeric_limits<double>::min() ? -1e30 : log2_normal(x);
    };
    return {ior, normal_reflectance(ior, 0.0), exact ? 1.0 : 0.0,
            Vec3d(log2_of(filter.x), log2_of(filter.y), log2_of(filter.z))};
  }
  MaterialTraits traits() const {
    return {.mirrors = true, .transmits = true, .filters = log2_filter != Vec3d(0)};
  }
};

template <class T>
class RefractiveKernel final : public MaterialRecords<Refractive, T> {
 public:
  using N = Lanes<T>;
  using MaterialRecords<Refractive, T>::MaterialRecords;

  // Snell's law by the side the ray comes from. Beyond the critical angle all is mirrored and nothing is
  // lost.
  void specular(const RayBatch<T>& rays, const HitBatch<T>& hits, const SurfaceBatch<T>& surface,
                const Groups& groups, SpecularBatch<T>& out) const override {
    using std::sqrt;
    const N zero(T(0)), one(T(1));
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Refractive<N>& glass) {
      const Vec3<N> direction = rays.direction.at(i), normal = surface.normal.at(i);
      const auto inside = surface.side.at(i) < zero;
      const N eta = select(inside, glass.ior, N(one / glass.ior));
      const N cos_incident = min_first(one, max_first(zero, N(-dot(direction, normal))));
      const N cos2_transmitted = one - eta * eta * (one - cos_incident * cos_incident);
      const auto total = !(cos2_transmitted > zero);
      const N cos_transmitted = sqrt(select(total, zero, cos2_transmitted));
      const N thinner = select(eta > one, cos_transmitted, cos_incident);
      N r = fresnel_schlick(glass.f0, thinner);
      const auto equations = glass.exact > zero;
      if (any(equations)) r = select(equations, fresnel_dielectric(eta, cos_incident, cos_transmitted), r);
      r = select(total, one, r);
      out.reflectance.put(i, mine, Vec3<N>(r));
      out.transmittance.put(i, mine, Vec3<N>(one - r));
      out.refracted.put(i, mine,
                        normalize(direction * eta + normal * (eta * cos_incident - cos_transmitted)));
      const N depth = select(inside, hits.t.at(i), zero);
      const Vec3<N>& f = glass.log2_filter;
      out.filter.put(i, mine,
                     {exp2_flushed(f.x * depth), exp2_flushed(f.y * depth), exp2_flushed(f.z * depth)});
    });
  }
};

}  // namespace

MaterialType refractive_type() {
  return {"refractive", "Clear glass: mirrors and refracts, may filter light inside.",
          make_material_set<Refractive, RefractiveKernel>};
}

}  // namespace orrery
