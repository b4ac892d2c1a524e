#include "core/materials/fresnel.h"
#include "core/materials/material_set.h"
#include "core/params/params.h"

namespace orrery {
namespace {

template <class N>
struct Reflective {
  Vec3<N> n, k;  // index of refraction and extinction
  Vec3<N> f0;    // reflectance along the normal
  N exact;       // 1: Fresnel's equations, 0: Schlick's approximation

  static Reflective<double> read(Params& p) {
    const Vec3d n = p.color("n", "Index of refraction of the metal, per channel.");
    const Vec3d k = p.color("k", "Extinction of the metal, per channel.");
    const bool exact =
        p.choice("fresnel", "How the reflectance is computed.", {"schlick", "exact"}, "schlick") == "exact";
    const Vec3d f0(normal_reflectance(n.x, k.x), normal_reflectance(n.y, k.y), normal_reflectance(n.z, k.z));
    return {n, k, f0, exact ? 1.0 : 0.0};
  }
  MaterialTraits traits() const { return {.mirrors = true}; }

  Vec3<N> reflectance(const N& cosine) const {
    const auto equations = exact > N(ScalarOf<N>(0));
    Vec3<N> r(fresnel_schlick(f0.x, cosine), fresnel_schlick(f0.y, cosine), fresnel_schlick(f0.z, cosine));
    if (any(equations))
      r = {select(equations, fresnel_conductor(n.x, k.x, cosine), r.x),
           select(equations, fresnel_conductor(n.y, k.y, cosine), r.y),
           select(equations, fresnel_conductor(n.z, k.z, cosine), r.z)};
    return r;
  }
};

template <class T>
class ReflectiveKernel final : public MaterialRecords<Reflective, T> {
 public:
  using N = Lanes<T>;
  using MaterialRecords<Reflective, T>::MaterialRecords;

  void specular(const RayBatch<T>& rays, const HitBatch<T>&, const SurfaceBatch<T>& surface,
                const Groups& groups, SpecularBatch<T>& out) const override {
    const N zero(T(0)), one(T(1));
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Reflective<N>& metal) {
      const N cosine = -dot(rays.direction.at(i), surface.normal.at(i));
      out.reflectance.put(i, mine, metal.reflectance(min_first(one, max_first(zero, cosine))));
      out.transmittance.put(i, mine, Vec3<N>(zero));
      out.filter.put(i, mine, Vec3<N>(one));
    });
  }
};

}  // namespace

MaterialType reflective_type() {
  return {"reflective", "A metal mirror coloured by Fresnel's law.",
          make_material_set<Reflective, ReflectiveKernel>};
}

}  // namespace orrery
