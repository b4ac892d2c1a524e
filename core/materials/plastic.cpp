#include "core/materials/plastic.h"

#include "core/math/mirror.h"
#include "core/params/params.h"

namespace orrery {

// The internal reflectance of the coat for diffuse light is 1 - (1 - E) / n^2, where E is the coat's mean
// reflectance from outside.
template <class N>
Plastic<double> Plastic<N>::read(Params& p) {
  const Vec3d reflectance =
      p.coefficient("reflectance", "Reflectance of the base, 0 to 1 per channel.", Vec3d(0.8), 1);
  const double ior = p.number("ior", "Index of refraction of the coat, divided by the index outside.",
                              {.min = 1, .max = 10}, 1.5);
  const double roughness =
      p.number("roughness",
               "Roughness of the coat from 0 (smooth) to 1; its square is the alpha of the GGX distribution.",
               {.min = 0, .max = 1}, 0.3);
  Plastic<double> plastic{{}, ior, roughness * roughness, {}, 0};
  if (plastic.alpha < kMinAlpha) {
    plastic.alpha = 0;
    plastic.mean = mean_dielectric(1 / ior);
  } else {
    plastic.mirror = mirrored_albedo(plastic.alpha, [&](double cosine) { return plastic.fresnel(cosine); });
    plastic.mean = plastic.mirror.mean;
  }
  const double mean = plastic.mean;
  const double leaves = (1 - mean) / (ior * ior);
  const auto base = [&](double rho) { return rho * leaves / (1 - rho * (1 - leaves)) / (1 - mean); };
  plastic.base = {base(reflectance.x), base(reflectance.y), base(reflectance.z)};
  return plastic;
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
