#pragma once

#include "core/materials/glass.h"
#include "core/math/mirror.h"

namespace orrery {

// Kernel of Glass, and of records that derive from it.
template <template <class> class Record, class T>
class GlassKernelOf final : public LobeKernel<Record, T> {
 public:
  using N = Lanes<T>;
  using LobeKernel<Record, T>::LobeKernel;

  void sample(const RayBatch<T>& rays, const HitBatch<T>& hits, const SurfaceBatch<T>& surface,
              const PathDraws<T>& draws, const LaneGroups& groups, Lobes lobes,
              ScatterBatch<T>& out) const override {
    const N zero(T(0));
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Record<N>& record) {
      const Glass<N> glass = record.between_media(surface, i);
      const auto [u, v] = draws.two(SampleSet::lobe, i);
      const auto rough = mine && glass.alpha > zero, smooth = mine && !rough;
      if (any(rough)) {
        const N side = draws.two(SampleSet::survival, i).v;
        this->sample_rough(rays, surface, i, rough, record, lobes, {u, v, side}, out);
      }
      if (!any(smooth)) return;
      const Vec3<N> direction = rays.direction.at(i), normal = surface.normal.at(i);
      const auto inside = surface.side.at(i) < zero;
      const auto split = glass.body.split(direction, normal, inside);
      const Vec3<N> back = mirrored(direction, normal, surface.geometric.at(i)), on = split.refracted;
      out.direction.put(i, smooth, select(u < split.reflectance, back, on));
      out.weight.put(i, smooth, glass.body.filter(select(inside, hits.t.at(i), zero)));
      out.pdf.put(i, smooth, zero);
    });
  }

  void specular(const RayBatch<T>& rays, const HitBatch<T>& hits, const SurfaceBatch<T>& surface,
                const LaneGroups& groups, SpecularBatch<T>& out) const override {
    const N zero(T(0)), one(T(1));
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Record<N>& record) {
      const Glass<N> glass = record.between_media(surface, i);
      const auto inside = surface.side.at(i) < zero;
      const auto split = glass.body.split(rays.direction.at(i), surface.normal.at(i), inside);
      const N smooth = select(glass.alpha > zero, zero, one);
      out.reflectance.put(i, mine, Vec3<N>(split.reflectance * smooth));
      out.transmittance.put(i, mine, Vec3<N>((one - split.reflectance) * smooth));
      out.refracted.put(i, mine, split.refracted);
      const auto crossed = inside && smooth > zero;
      out.filter.put(i, mine, glass.body.filter(select(crossed, hits.t.at(i), zero)));
    });
  }
};

}  // namespace orrery
