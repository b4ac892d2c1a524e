#pragma once

#include "core/materials/material_set.h"
#include "core/math/hemisphere.h"

namespace orrery {

// Kernel of materials that scatter over the whole hemisphere and are sampled in proportion to the cosine. In
// addition to the members listed in material_set.h, a record has
//   Vec3<N> reflectance;                     approximate albedo under uniform light
//   Vec3<N> pi_brdf(light, viewer, between)  pi times the BRDF, as a function of N.L > 0, N.V and L.V
template <template <class> class Record, class T>
class DiffuseKernel final : public MaterialRecords<Record, T> {
 public:
  using N = Lanes<T>;
  using MaterialRecords<Record, T>::MaterialRecords;

  void ambient(const RayBatch<T>&, const SurfaceBatch<T>& surface, const LaneGroups& groups, Lobes,
               const Vec3<T>& ambient, Vec3Array<T>& radiance) const override {
    const Vec3<N> from_everywhere(ambient);
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Record<N>& record) {
      radiance.put(i, mine, record.reflectance * from_everywhere);
    });
  }

  void evaluate(const Directions<T>& directions, const SurfaceBatch<T>& surface, const LaneGroups& groups,
                Lobes, Vec3Array<T>& pi_bsdf_cos, Array<T>& pdf) const override {
    const N zero(T(0));
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Record<N>& record) {
      const Vec3<N> normal = surface.normal.at(i), light = directions.light.at(i);
      const N cosine = dot(normal, light);
      const auto lit =
          mine && directions.reach.at(i) > zero && cosine > zero && directions.side_cosine(surface, i) > zero;
      pdf.put(i, mine, select(lit, cosine_pdf(cosine), zero));
      if (any(lit))
        pi_bsdf_cos.put(i, mine, pi_brdf(record, normal, light, -directions.ray.at(i), cosine) * cosine);
    });
  }

  // Samples directions with density proportional to the cosine, so the weight (BRDF times cosine over
  // density) is pi times the BRDF.
  void sample(const RayBatch<T>& rays, const HitBatch<T>&, const SurfaceBatch<T>& surface,
              const PathDraws<T>& draws, const LaneGroups& groups, Lobes,
              ScatterBatch<T>& out) const override {
    const N zero(T(0));
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Record<N>& record) {
      const auto [u, v] = draws.two(SampleSet::lobe, i);
      const Vec3<N> normal = surface.normal.at(i), light = cosine_direction(normal, u, v);
      const N cosine = dot(normal, light);
      const auto leaves = cosine > zero && dot(surface.geometric.at(i), light) > zero;
      const Vec3<N> weight = pi_brdf(record, normal, light, -rays.direction.at(i), cosine);
      out.direction.put(i, mine, light);
      out.weight.put(i, mine, Vec3<N>(zero));
      out.weight.put(i, mine && leaves, weight);
      out.pdf.put(i, mine, select(leaves, cosine_pdf(cosine), zero));
    });
  }

 private:
  static Vec3<N> pi_brdf(const Record<N>& record, const Vec3<N>& normal, const Vec3<N>& light,
                         const Vec3<N>& viewer, const N& cosine) {
    return record.pi_brdf(cosine, dot(normal, viewer), dot(light, viewer));
  }
};

}  // namespace orrery
