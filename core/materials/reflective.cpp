#include "core/materials/reflective.h"

#include "core/materials/material_set.h"
#include "core/math/mirror.h"
#include "core/params/params.h"

namespace orrery {

template <>
void ReflectiveInputs<double>::read(MaterialParams& p) {
  p.color(n, "n", "Index of refraction, per channel.");
  p.color(k, "k", "Extinction coefficient, per channel.");
  exact = p.plain().choice("fresnel", "Reflectance formula: Schlick's approximation or Fresnel's equations.",
                           {"schlick", "exact"}, "schlick") == "exact";
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
