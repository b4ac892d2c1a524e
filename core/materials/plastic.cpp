#include "core/materials/plastic.h"

#include "core/math/mirror.h"
#include "core/params/params.h"

namespace orrery {
template <>
void PlasticInputs<double>::tabulate(double of_roughness) {
  alpha = of_roughness * of_roughness;
  if (alpha < kMinAlpha) {
    alpha = 0;
    mean = mean_dielectric(1 / ior);
    return;
  }
  const Plastic<double> coat{{}, ior, alpha, {}, 0};
  mirror = mirrored_albedo(alpha, [&](double cosine) { return coat.fresnel(cosine); });
  mean = mirror.mean;
}

template <>
void PlasticInputs<double>::read(MaterialParams& p) {
  p.coefficient(reflectance, "reflectance", "Reflectance of the base, 0 to 1 per channel.", Vec3d(0.8), 1);
  ior = p.plain().number("ior", "Index of refraction of the coat, divided by the index outside.",
                         {.min = 1, .max = 10}, 1.5);
  p.number(roughness, "roughness",
           "Roughness of the coat from 0 (smooth) to 1; its square is the alpha of the GGX distribution.",
           {.min = 0, .max = 1}, 0.3);
  if (p.raise_texture(roughness, kMinTexturedRoughness)) roughness = kMinTexturedRoughness;
}

namespace {

template <class T>
class PlasticKernel final : public LobeKernel<Plastic, T> {
 public:
  using N = Lanes<T>;
  using LobeKernel<Plastic, T>::LobeKernel;

  void sample(const RayBatch<T>& rays, const HitBatch<T>&, const SurfaceBatch<T>& surface,
              const PathDraws<T>& draws, const LaneGroups& groups, Lobes lobes,
              ScatterBatch<T>& out) const override {
    const N zero(T(0)), one(T(1));
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Plastic<N>& plastic) {
      const auto [u, v] = draws.two(SampleSet::lobe, i);
      const LobeDraw<N> draw{u, v, zero};
      const auto smooth = mine && !(plastic.alpha > zero);
      if (!any(smooth)) return this->sample_rough(rays, surface, i, mine, plastic, lobes, draw, out);
      const Vec3<N> direction = rays.direction.at(i), normal = surface.normal.at(i);
      const Vec3<N> geometric = surface.geometric.at(i);
      const N share = plastic.fresnel(dot(ShadingFrame<N>(normal, geometric, -direction).normal, -direction));
      const N chance = select(smooth, plastic.coat_chance(share, lobes), zero);
      const auto [coat, rest] = draw.choose(chance);
      this->sample_rough(rays, surface, i, mine && !coat, plastic, lobes, {rest, v, zero}, out);
      out.direction.put(i, coat && mine, orrery::mirrored(direction, normal, geometric));
      out.weight.put(i, coat && mine, Vec3<N>(share / select(coat, chance, one)));
      out.pdf.put(i, coat && mine, zero);
    });
  }

  void specular(const RayBatch<T>& rays, const HitBatch<T>&, const SurfaceBatch<T>& surface,
                const LaneGroups& groups, SpecularBatch<T>& out) const override {
    const N zero(T(0)), one(T(1));
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Plastic<N>& plastic) {
      const Vec3<N> viewer = -rays.direction.at(i);
      const ShadingFrame<N> frame(surface.normal.at(i), surface.geometric.at(i), viewer);
      const N share = plastic.fresnel(dot(frame.normal, viewer));
      out.reflectance.put(i, mine, Vec3<N>(select(plastic.alpha > zero, zero, share)));
      out.transmittance.put(i, mine, Vec3<N>(zero));
      out.filter.put(i, mine, Vec3<N>(one));
    });
  }
};

}  // namespace

MaterialType plastic_type() {
  return {"plastic", "A diffuse base under a smooth or rough clear coat.",
          make_material_set<Plastic, PlasticKernel>};
}

}  // namespace orrery
