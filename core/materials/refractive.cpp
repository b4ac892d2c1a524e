#include "core/materials/refractive.h"

#include "core/materials/material_set.h"
#include "core/math/mirror.h"
#include "core/params/params.h"

namespace orrery {

double read_priority(Params& p) {
  constexpr double kMaxPriority = 1e6;
  return p.number(
      "priority",
      "Where bodies overlap, the body of highest priority displaces the others; of equal ones, the "
      "body that a ray entered last.",
      {.min = -kMaxPriority, .max = kMaxPriority}, 0.0);
}

template <class N>
Refractive<double> Refractive<N>::read(Params& p) {
  const double ior = p.number("ior", "Index of refraction; air: 1.", {.min = 0.01, .max = 100});
  const bool exact =
      p.choice("fresnel", "Reflectance formula: Schlick's approximation or Fresnel's equations.",
               {"schlick", "exact"}, "schlick") == "exact";
  const Vec3d filter =
      p.color("filter", "Transmittance after one metre inside, 0 to 1 per channel.", Vec3d(1), 1);
  return {ior, normal_reflectance(ior, 0.0), exact ? 1.0 : 0.0, log2_filter_of(filter), read_priority(p)};
}

namespace {

template <class T>
class RefractiveKernel final : public MaterialRecords<Refractive, T> {
 public:
  using N = Lanes<T>;
  using MaterialRecords<Refractive, T>::MaterialRecords;

  void specular(const RayBatch<T>& rays, const HitBatch<T>& hits, const SurfaceBatch<T>& surface,
                const LaneGroups& groups, SpecularBatch<T>& out) const override {
    const N zero(T(0)), one(T(1));
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Refractive<N>& body) {
      const Refractive<N> glass = body.between_media(surface, i);
      const auto inside = surface.side.at(i) < zero;
      const auto split = glass.split(rays.direction.at(i), surface.normal.at(i), inside);
      out.reflectance.put(i, mine, Vec3<N>(split.reflectance));
      out.transmittance.put(i, mine, Vec3<N>(one - split.reflectance));
      out.refracted.put(i, mine, split.refracted);
      out.filter.put(i, mine, glass.filter(select(inside, hits.t.at(i), zero)));
    });
  }

  // Samples the mirrored ray with a probability equal to the reflectance, and otherwise the refracted ray.
  void sample(const RayBatch<T>& rays, const HitBatch<T>& hits, const SurfaceBatch<T>& surface,
              const PathDraws<T>& draws, const LaneGroups& groups, Lobes,
              ScatterBatch<T>& out) const override {
    const N zero(T(0));
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Refractive<N>& body) {
      const Refractive<N> glass = body.between_media(surface, i);
      const Vec3<N> direction = rays.direction.at(i), normal = surface.normal.at(i);
      const auto inside = surface.side.at(i) < zero;
      const auto split = glass.split(direction, normal, inside);
      const auto mirrors = draws.two(SampleSet::lobe, i).u < split.reflectance;
      const Vec3<N> back = mirrored(direction, normal, surface.geometric.at(i)), on = split.refracted;
      out.direction.put(i, mine, select(mirrors, back, on));
      out.weight.put(i, mine, glass.filter(select(inside, hits.t.at(i), zero)));
      out.pdf.put(i, mine, zero);
    });
  }
};

}  // namespace

MaterialType refractive_type() {
  return {"refractive", "Smooth glass: reflects, refracts and may absorb light.",
          make_material_set<Refractive, RefractiveKernel>};
}

}  // namespace orrery
