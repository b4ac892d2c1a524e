#include "core/materials/hall.h"

#include <numbers>

#include "core/base/task_scope.h"
#include "core/math/mirror.h"
#include "core/params/params.h"

namespace orrery {

template <class N>
Hall<double> Hall<N>::read(Params& p) {
  constexpr Range kExponents{.min = 0, .max = 1e6};
  const Vec3d kd = p.coefficient("kd", "Diffuse reflection of direct light.", Vec3d(0), 1);
  const Vec3d ka = p.coefficient("ka", "Reflection of ambient light; default: kd.", derived(kd), 1);
  const Vec3d cd = p.color("diffuse_color", "Colour that multiplies ka and kd.", Vec3d(1), 1);
  const Vec3d ks = p.coefficient("ks", "Specular reflection of sources and rays.", Vec3d(1), 1);
  const Vec3d kt = p.coefficient("kt", "Specular transmission of sources and rays.", Vec3d(1), 1);
  const Vec3d ktd =
      p.coefficient("kt_diffuse", "Diffuse transmission of direct light from behind.", Vec3d(0), 1);
  const Vec3d tint = p.color("reflection_color", "Colour of reflection along the normal.", Vec3d(1), 1);
  const double shininess = p.number("shininess", "Exponent of the reflected highlight.", kExponents, 20.0);
  const double transmitted =
      p.number("transmitted_shininess", "Exponent of the transmitted highlight; default: shininess.",
               kExponents, derived(shininess));
  const double ior = p.number("ior", "Index of refraction; air: 1.", {.min = 0.01, .max = 100}, 1.5);
  const Vec3d filter =
      p.color("filter", "Transmittance after one metre inside, 0 to 1 per channel.", Vec3d(1), 1);
  const Refractive<double> body{ior, normal_reflectance(ior, 0.0), 1.0, log2_filter_of(filter),
                                read_priority(p)};
  return {ka * cd, kd * cd, ktd, ks, kt, tint, shininess, transmitted, body};
}

// As Rough::rounding().
template <class N>
RoundingLimit Hall<N>::rounding() const {
  constexpr double kMaxError = 2e-3;
  const double most = std::max(shininess, transmitted_shininess);
  if (most == 0) return {};
  return {kMaxError / most, "its highlight has an exponent of " + number_text(most)};
}

// Integrates the direct light of a uniform sky for views from both sides, and adds reflected and refracted
// rays.
template <class N>
ReflectionLimits Hall<N>::limits() const {
  constexpr int kViews = 8, kSteps = 48;
  Vec3d most;
  for (const bool inside : {false, true})
    for (int v = 0; v < kViews; ++v) {
      checkpoint();
      const double z = (v + 0.5) / kViews;
      const Vec3d viewer(std::sqrt(1 - z * z), 0, z);
      const Vec3d mirrored = reflectance_at(z, inside);
      Vec3d sum = specular * mirrored + transmission * (Vec3d(1) - mirrored);
      for (int i = 0; i < 2 * kSteps; ++i)
        for (int j = 0; j < kSteps; ++j) {
          const double up = (i + 0.5) / kSteps - 1, across = std::sqrt(1 - up * up);
          const double angle = 2 * std::numbers::pi * (j + 0.5) / kSteps;
          const Vec3d light(across * std::cos(angle), across * std::sin(angle), up);
          sum = sum + scattered(viewer, light, inside, Lobes::all).pi_bsdf_cos * (2.0 / (kSteps * kSteps));
        }
      most = largest(most, sum);
    }
  const Vec3d rays = largest(specular, transmission);
  return {ambient, largest(diffuse + specular, diffuse_transmission + transmission), most, false, rays};
}

namespace {

template <class T>
class HallKernel final : public LobeKernel<Hall, T> {
 public:
  using N = Lanes<T>;
  using LobeKernel<Hall, T>::LobeKernel;

  void ambient(const RayBatch<T>&, const SurfaceBatch<T>& surface, const LaneGroups& groups, Lobes lobes,
               const Vec3<T>& ambient, Vec3Array<T>& radiance) const override {
    const Vec3<N> from_everywhere(ambient);
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Hall<N>& alone) {
      const Hall<N> hall = alone.between_media(surface, i);
      const auto inside = surface.side.at(i) < N(T(0));
      radiance.put(i, mine,
                   hall.ambient_reflectance(N(T(1)), lobes) * from_everywhere *
                       hall.body_transmittance(inside, surface.travelled.at(i)));
    });
  }

  void sample(const RayBatch<T>& rays, const HitBatch<T>& hits, const SurfaceBatch<T>& surface,
              const PathDraws<T>& draws, const LaneGroups& groups, Lobes lobes,
              ScatterBatch<T>& out) const override {
    const N zero(T(0)), one(T(1));
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Hall<N>& alone) {
      const auto [u, v] = draws.two(SampleSet::lobe, i);
      const N side = draws.two(SampleSet::survival, i).v;
      const Ray at = ray_at(rays, hits, surface, i, alone);
      const auto chance = at.hall.chances(at.cosine, at.inside, lobes);
      const auto [specular, rest] = LobeDraw<N>{u, v, side}.choose(chance.specular);
      this->sample_rough(rays, surface, i, mine && !specular, alone, lobes, {rest, v, side}, out);
      const auto mirrors = side < chance.mirror;
      const N share = chance.specular * select(mirrors, chance.mirror, N(one - chance.mirror));
      const Vec3<N> weight = select(mirrors, at.reflectance, at.transmittance) * at.filter;
      out.direction.put(i, mine && specular, select(mirrors, at.reflected, at.refracted));
      out.weight.put(i, mine && specular, weight * (one / select(specular, share, one)));
      out.pdf.put(i, mine && specular, zero);
    });
  }

  // The weights of rays contain the filter, as evaluate() and ambient() do.
  void specular(const RayBatch<T>& rays, const HitBatch<T>& hits, const SurfaceBatch<T>& surface,
                const LaneGroups& groups, SpecularBatch<T>& out) const override {
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Hall<N>& alone) {
      const Ray at = ray_at(rays, hits, surface, i, alone);
      out.reflectance.put(i, mine, at.reflectance * at.filter);
      out.transmittance.put(i, mine, at.transmittance * at.filter);
      out.refracted.put(i, mine, at.refracted);
      out.filter.put(i, mine, Vec3<N>(N(T(1))));
    });
  }

 private:
  // Perfectly specular scattering of the rays in a register.
  struct Ray {
    Hall<N> hall;
    MaskOf<N> inside;
    N cosine;
    Vec3<N> reflectance, transmittance, filter, reflected, refracted;
  };
  static Ray ray_at(const RayBatch<T>& rays, const HitBatch<T>& hits, const SurfaceBatch<T>& surface, int i,
                    const Hall<N>& alone) {
    const N zero(T(0));
    const Vec3<N> direction = rays.direction.at(i), geometric = surface.geometric.at(i);
    const Vec3<N> normal = ShadingFrame<N>(surface.normal.at(i), geometric, -direction).normal;
    Ray at{alone.between_media(surface, i),
           surface.side.at(i) < zero,
           -dot(normal, direction),
           {},
           {},
           {},
           {},
           {}};
    const auto split = at.hall.body.split(direction, normal, at.inside);
    const Vec3<N> mirrored_share = at.hall.reflectance(split.reflectance);
    at.reflectance = at.hall.specular * mirrored_share;
    at.transmittance = at.hall.transmission * (Vec3<N>(N(T(1))) - mirrored_share);
    at.filter = at.hall.body.filter(select(at.inside, hits.t.at(i), zero));
    at.reflected = mirrored(direction, normal, geometric);
    at.refracted = split.refracted;
    return at;
  }
};

}  // namespace

MaterialType hall_type() {
  return {"hall", "Reflection and transmission of sources and rays, coloured by Fresnel (Hall 1983).",
          make_material_set<Hall, HallKernel>};
}

}  // namespace orrery
