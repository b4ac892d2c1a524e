#include "core/materials/reflective.h"

#include "core/materials/material_set.h"
#include "core/math/mirror.h"
#include "core/params/params.h"

namespace orrery {

template <class N>
Reflective<double> Reflective<N>::read(Params& p) {
  const Vec3d n = p.color("n", "Index of refraction, per channel.");
  const Vec3d k = p.color("k", "Extinction coefficient, per channel.");
  const bool exact =
      p.choice("fresnel", "Reflectance formula: Schlick's approximation or Fresnel's equations.",
               {"schlick", "exact"}, "schlick") == "exact";
  const Vec3d f0(normal_reflectance(n.x, k.x), normal_reflectance(n.y, k.y), normal_reflectance(n.z, k.z));
  return {n, k, f0, exact ? 1.0 : 0.0};
}

namespace {

template <class T>
class ReflectiveKernel final : public MaterialRecords<Reflective, T> {
 public:
  using N = Lanes<T>;
  using MaterialRecords<Reflective, T>::MaterialRecords;

  void specular(const RayBatch<T>& rays, const HitBatch<T>&, const SurfaceBatch<T>& surface,
                const LaneGroups& groups, SpecularBatch<T>& out) const override {
    const N zero(T(0)), one(T(1));
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Reflective<N>& metal) {
      const N cosine = -dot(rays.direction.at(i), surface.normal.at(i));
      out.reflectance.put(i, mine, metal.reflectance(min_first(one, max_first(zero, cosine))));
      out.transmittance.put(i, mine, Vec3<N>(zero));
      out.filter.put(i, mine, Vec3<N>(one));
    });
  }

  void sample(const RayBatch<T>& rays, const HitBatch<T>&, const SurfaceBatch<T>& surface,
              const PathDraws<T>&, const LaneGroups& groups, Lobes, ScatterBatch<T>& out) const override {
    const N zero(T(0)), one(T(1));
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Reflective<N>& metal) {
      const Vec3<N> direction = rays.direction.at(i), normal = surface.normal.at(i);
      const N cosine = min_first(one, max_first(zero, N(-dot(direction, normal))));
      out.direction.put(i, mine, mirrored(direction, normal, surface.geometric.at(i)));
      out.weight.put(i, mine, metal.reflectance(cosine));
      out.pdf.put(i, mine, zero);
    });
  }
};

}  // namespace

MaterialType reflective_type() {
  return {"reflective", "A smooth metal, coloured by Fresnel reflection.",
          make_material_set<Reflective, ReflectiveKernel>};
}

}  // namespace orrery
