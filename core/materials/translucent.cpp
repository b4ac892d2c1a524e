#include "core/materials/translucent.h"

#include <algorithm>

#include "core/materials/material_set.h"
#include "core/math/hemisphere.h"
#include "core/params/params.h"

namespace orrery {

template <>
void TranslucentInputs<double>::read(MaterialParams& p) {
  p.coefficient(reflectance, "reflectance", "Diffuse reflectance, 0 to 1 per channel.", Vec3d(0.4), 1);
  const Vec3d back = p.most(reflectance);
  const Vec3d left(std::min(0.4, 1 - back.x), std::min(0.4, 1 - back.y), std::min(0.4, 1 - back.z));
  p.coefficient(transmittance, "transmittance",
                "Diffuse transmittance, 0 to 1 per channel; default: 0.4, or 1 - reflectance "
                "if that is less.",
                left, 1);
  const double most = max_component(back + p.most(transmittance));
  if (most > 1)
    p.plain().fail("transmittance", "reflectance + transmittance must be at most 1 in every channel (got " +
                                        number_text(most) + ")");
}

namespace {

template <class T>
class TranslucentKernel final : public MaterialRecords<Translucent, T> {
 public:
  using N = Lanes<T>;
  using MaterialRecords<Translucent, T>::MaterialRecords;

  void ambient(const RayBatch<T>&, const SurfaceBatch<T>& surface, const LaneGroups& groups, Lobes lobes,
               const Vec3<T>& ambient, Vec3Array<T>& radiance) const override {
    const Vec3<N> from_everywhere(ambient);
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Translucent<N>& sheet) {
      const Vec3<N> zero(N(T(0)));
      radiance.put(i, mine,
                   ((with_diffuse(lobes) ? sheet.reflectance : zero) +
                    (with_non_diffuse(lobes) ? sheet.transmittance : zero)) *
                       from_everywhere);
    });
  }

  void evaluate(const Directions<T>& directions, const SurfaceBatch<T>& surface, const LaneGroups& groups,
                Lobes lobes, Vec3Array<T>& pi_bsdf_cos, Array<T>& pdf) const override {
    using std::abs;
    const N zero(T(0));
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Translucent<N>& sheet) {
      const Vec3<N> light = directions.light.at(i);
      const N cosine = dot(surface.normal.at(i), light);
      const auto lit =
          mine && directions.reach.at(i) > zero && cosine * dot(surface.geometric.at(i), light) > zero;
      const auto through = cosine < zero;
      pdf.put(i, mine, select(lit, density(through, through_chance(sheet, lobes), abs(cosine)), zero));
      if (any(lit)) pi_bsdf_cos.put(i, mine, share(sheet, through) * abs(cosine));
    });
  }

  void sample(const RayBatch<T>&, const HitBatch<T>&, const SurfaceBatch<T>& surface,
              const PathDraws<T>& draws, const LaneGroups& groups, Lobes lobes,
              ScatterBatch<T>& out) const override {
    using std::abs;
    const N zero(T(0)), one(T(1));
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Translucent<N>& sheet) {
      const auto [u, v] = draws.two(SampleSet::lobe, i);
      const N share_through = through_chance(sheet, lobes);
      const auto through = u < share_through;
      const N chance = select(through, share_through, N(one - share_through));
      const N rest = select(through, u, N(u - share_through)) / chance;
      const Vec3<N> normal = surface.normal.at(i);
      const Vec3<N> light =
          cosine_direction(select(through, -normal, normal),
                           min_first(N(T(1) - std::numeric_limits<T>::epsilon() / 2), rest), v);
      const N cosine = dot(normal, light);
      const auto leaves =
          mine && cosine * dot(surface.geometric.at(i), light) > zero && (cosine < zero) == through;
      out.direction.put(i, mine, light);
      out.weight.put(i, mine, Vec3<N>(zero));
      out.weight.put(i, leaves, share(sheet, through) * (one / chance));
      out.pdf.put(i, mine, select(leaves, density(through, share_through, abs(cosine)), zero));
    });
  }

 private:
  static Vec3<N> share(const Translucent<N>& sheet, const MaskOf<N>& through) {
    return select(through, sheet.transmittance, sheet.reflectance);
  }
  // Returns the probability of sampling a transmitted direction with these lobes.
  static N through_chance(const Translucent<N>& sheet, Lobes lobes) {
    return lobes == Lobes::all ? sheet.through : N(T(with_non_diffuse(lobes) ? 1 : 0));
  }
  static N density(const MaskOf<N>& through, const N& through_chance, const N& cosine) {
    return select(through, through_chance, N(N(T(1)) - through_chance)) * cosine_pdf(cosine);
  }
};

}  // namespace

MaterialType translucent_type() {
  return {"translucent", "A thin sheet that scatters light to both sides, such as paper or a leaf.",
          make_material_set<Translucent, TranslucentKernel>};
}

}  // namespace orrery
