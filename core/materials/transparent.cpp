#include "core/materials/transparent.h"

#include "core/materials/lobes.h"
#include "core/materials/material_set.h"
#include "core/params/params.h"

namespace orrery {

template <class N>
Transparent<double> Transparent<N>::read(Params& p) {
  constexpr double kMaxTransmission = 10;
  Rough<double> front = read_rough(p);
  const bool interpolated = p.choice("blend", "Interpolated: (1 - kt) I1 + kt I2. Filtered: I1 + kt Ct I2.",
                                     {"interpolated", "filtered"}, "interpolated") == "interpolated";
  const double kt =
      p.number("kt", "Transmission coefficient: share of the light from behind; at most 1 if interpolated.",
               {.min = 0, .max = kMaxTransmission}, 0.5);
  const Vec3d ct =
      p.color("transmission_color", "Colour Ct of the transmitted light; only if filtered.", Vec3d(1), 1);
  if (interpolated && kt > 1)
    p.fail("kt", "must be at most 1 for an interpolated blend (got " + number_text(kt) + ")");
  if (interpolated && p.has("transmission_color"))
    p.fail("transmission_color", "requires \"blend\": \"filtered\"");
  if (interpolated) {
    front.ambient = front.ambient * (1 - kt);
    front.diffuse = front.diffuse * (1 - kt);
  }
  const Vec3d transmittance = interpolated ? Vec3d(kt) : ct * kt;
  const double passes = max_component(transmittance);
  const double highlight = max_component(front.specular) * front.highlight_albedo();
  return {front, transmittance, lobe_chance(passes, max_component(front.diffuse) + highlight),
          lobe_chance(passes, highlight)};
}

namespace {

template <class T>
class TransparentKernel final : public MaterialRecords<Transparent, T> {
 public:
  using N = Lanes<T>;

  TransparentKernel(std::span<const Transparent<double>> records, int first)
      : MaterialRecords<Transparent, T>(records, first), front_(make_front(records, first)) {}

  void ambient(const RayBatch<T>& rays, const SurfaceBatch<T>& surface, const LaneGroups& groups, Lobes lobes,
               const Vec3<T>& ambient, Vec3Array<T>& radiance) const override {
    front_->ambient(rays, surface, groups, lobes, ambient, radiance);
  }

  void evaluate(const Directions<T>& directions, const SurfaceBatch<T>& surface, const LaneGroups& groups,
                Lobes lobes, Vec3Array<T>& pi_bsdf_cos, Array<T>& pdf) const override {
    front_->evaluate(directions, surface, groups, lobes, pi_bsdf_cos, pdf);
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Transparent<N>& pane) {
      pdf.put(i, mine, pdf.at(i) * reflects(pane, lobes));
    });
  }

  void sample(const RayBatch<T>& rays, const HitBatch<T>& hits, const SurfaceBatch<T>& surface,
              const PathDraws<T>& draws, const LaneGroups& groups, Lobes lobes,
              ScatterBatch<T>& out) const override {
    const N zero(T(0)), one(T(1));
    front_->sample(rays, hits, surface, draws, groups, lobes, out);
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Transparent<N>& pane) {
      const N chance = pane.chance(lobes), rest = reflects(pane, lobes);
      const auto passes = draws.two(SampleSet::survival, i).v < chance;
      const auto on = mine && passes, back = mine && !passes;
      out.weight.put(i, back, out.weight.at(i) * (one / rest));
      out.pdf.put(i, back, out.pdf.at(i) * rest);
      out.direction.put(i, on, rays.direction.at(i));
      out.weight.put(i, on, pane.transmittance * (one / select(passes, chance, one)));
      out.pdf.put(i, on, zero);
    });
  }

  void specular(const RayBatch<T>& rays, const HitBatch<T>&, const SurfaceBatch<T>& surface,
                const LaneGroups& groups, SpecularBatch<T>& out) const override {
    const N zero(T(0)), one(T(1));
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Transparent<N>& pane) {
      out.reflectance.put(i, mine, Vec3<N>(zero));
      out.transmittance.put(i, mine, pane.transmittance);
      out.refracted.put(i, mine, rays.direction.at(i));
      out.filter.put(i, mine, Vec3<N>(one));
    });
  }

 private:
  static MaterialKernelPtr<T> make_front(std::span<const Transparent<double>> records, int first) {
    std::vector<Rough<double>> fronts;
    for (const auto& record : records) fronts.push_back(record.front);
    return make_rough_kernel(T(), fronts, first);
  }
  // Returns the probability of sampling a reflected direction. If it is 0, reflection has albedo 0, and any
  // positive number keeps samples and evaluation equal.
  static N reflects(const Transparent<N>& pane, Lobes lobes) {
    const N one(T(1)), rest = one - pane.chance(lobes);
    return select(rest > N(T(0)), rest, one);
  }

  const MaterialKernelPtr<T> front_;
};

}  // namespace

MaterialType transparent_type() {
  return {"transparent", "A surface that light passes without refraction: interpolated or filtered.",
          make_material_set<Transparent, TransparentKernel>};
}

}  // namespace orrery
