#include "core/materials/metallic_roughness.h"

#include "core/materials/metal.h"
#include "core/params/params.h"

namespace orrery {
namespace {

constexpr double kDielectric = 0.04;  // reflectance of dielectrics along the normal

double mean_schlick(double f0) { return f0 + (1 - f0) / 21; }

}  // namespace

template <class N>
MetallicRoughness<double> MetallicRoughness<N>::read(Params& p) {
  const Vec3d color = p.coefficient(
      "base_color", "Albedo of the dielectric base, or reflectance of the metal, 0 to 1 per channel.",
      Vec3d(0.8), 1);
  const double metallic =
      p.number("metallic", "Metalness: 0 for a dielectric, 1 for a metal.", {.min = 0, .max = 1}, 0.0);
  const double roughness = p.number(
      "roughness",
      "Roughness from 0 (smooth) to 1; its square is the alpha of the GGX distribution, at least 0.001.",
      {.min = 0, .max = 1}, 0.5);
  const bool is_strict =
      p.flag("strict", "Use the glTF 2.0 formula unchanged, although it does not conserve energy.", false);
  MetallicRoughness<double> found{};
  found.f0 = Vec3d(kDielectric) * (1 - metallic) + color * metallic;
  found.base = color * (1 - metallic);
  found.strict = is_strict ? 1 : 0;
  found.alpha = std::max(kMinAlpha, roughness * roughness);
  found.albedo = ggx_albedo(found.alpha);
  found.grazing = mirrored_albedo(found.alpha, [](double cosine) { return fresnel_schlick(0.0, cosine); });
  if (is_strict) return found;
  const auto channel = [&](double f0, double& base, double& multiple) {
    multiple = multiple_scattering_reflectance(mean_schlick(f0), found.albedo.mean);
    const double all = found.albedo.mean, edge = found.grazing.mean;
    const double left = 1 - (f0 * (all - edge) + edge) - multiple * (1 - all);
    base = left > 0 ? base / left : 0;
  };
  channel(found.f0.x, found.base.x, found.multiple.x);
  channel(found.f0.y, found.base.y, found.multiple.y);
  channel(found.f0.z, found.base.z, found.multiple.z);
  return found;
}

// Returns 1 if `strict` is 0. Otherwise returns the largest albedo for five view directions, mostly grazing
// ones, where the albedo tends to be largest. The albedo is the single-scattering albedo of the facets, plus
// the base reflectance times the cosine-weighted mean of 1 - F over light directions.
template <class N>
double MetallicRoughness<N>::max_albedo() const {
  if (!(strict > 0)) return 1;
  constexpr int kSteps = 64;
  double most = 0;
  for (const double mu : {1.0, 0.5, 0.1, 0.02, 0.005}) {
    const Vec3d viewer(std::sqrt(1 - mu * mu), 0, mu);
    double matt = 0;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j) {
        const Vec3d light = cosine_direction(Vec3d(0, 0, 1), (i + 0.5) / kSteps, (j + 0.5) / kSteps);
        matt += (1 - fresnel_schlick(0.0, length(viewer + light) / 2)) / (kSteps * kSteps);
      }
    most = std::max(most, max_component(base * (Vec3d(1) - f0) * matt + albedos(mu).once));
  }
  return most;
}

namespace {

template <class T>
using MetallicRoughnessKernel = LobeKernel<MetallicRoughness, T>;

}  // namespace

MaterialType metallic_roughness_type() {
  return {"metallic-roughness", "The glTF 2.0 material, corrected to conserve energy.",
          make_material_set<MetallicRoughness, MetallicRoughnessKernel>};
}

}  // namespace orrery
