#include "core/materials/metallic_roughness.h"

#include "core/params/params.h"

namespace orrery {
template <>
void MetallicRoughnessInputs<double>::tabulate(double of_roughness) {
  alpha = std::max(kMinAlpha, of_roughness * of_roughness);
  albedo = ggx_albedo(alpha);
  grazing = mirrored_albedo(alpha, [](double cosine) { return fresnel_schlick(0.0, cosine); });
}

void read_metallic_roughness(MaterialParams& p, Vec3d& base_color, Vec3d& normal_reflectance,
                             double& metallic, double& roughness) {
  p.coefficient(base_color, "base_color",
                "Albedo of the dielectric base, or reflectance of the metal, 0 to 1 per channel.", Vec3d(0.8),
                1);
  constexpr double kDielectric = 0.04;  // default of glTF: an index of refraction of 1.5
  p.coefficient(normal_reflectance, "normal_reflectance",
                "Reflectance of the dielectric along the normal, 0 to 1 per channel.", Vec3d(kDielectric), 1);
  p.number(metallic, "metallic", "Metalness: 0 for a dielectric, 1 for a metal.", {.min = 0, .max = 1}, 0.0);
  p.number(roughness, "roughness",
           "Roughness from 0 (smooth) to 1; its square is the alpha of the GGX distribution, at least 0.001.",
           {.min = 0, .max = 1}, 0.5);
  if (p.raise_texture(roughness, kMinTexturedRoughness)) roughness = kMinTexturedRoughness;
}

template <>
void MetallicRoughnessInputs<double>::read(MaterialParams& p) {
  read_metallic_roughness(p, base_color, normal_reflectance, metallic, roughness);
  strict = p.plain().flag("strict",
                          "Use the glTF 2.0 formula unchanged, although it does not conserve energy.", false);
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
