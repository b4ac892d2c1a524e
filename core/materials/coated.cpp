#include "core/materials/coated.h"

#include "core/params/params.h"

namespace orrery {
template <>
void CoatedInputs<double>::tabulate(double of_roughness) {
  MetallicRoughnessInputs<double> base{};
  base.tabulate(of_roughness);
  alpha = base.alpha;
  albedo = base.albedo;
  grazing = base.grazing;
}

template <>
void CoatedInputs<double>::read(MaterialParams& p) {
  constexpr Range kFraction{.min = 0, .max = 1};
  read_metallic_roughness(p, base_color, normal_reflectance, metallic, roughness);
  p.number(coat, "coat", "Fraction of the surface that a clear coat of index 1.5 covers.", kFraction, 0.0);
  const double coat_roughness =
      p.plain().number("coat_roughness", "Roughness of the coat from 0 (smooth) to 1.", kFraction, 0.0);
  p.coefficient(sheen_color, "sheen_color", "Reflectance of fibres on the base, 0 to 1 per channel.",
                Vec3d(0), 1);
  const double sheen_roughness =
      p.plain().number("sheen_roughness",
                       "Roughness of the fibres, 0 to 1; the rim is narrow if it is small.", kFraction, 0.5);
  coat_alpha = std::max(kMinAlpha, coat_roughness * coat_roughness);
  coat_albedo = mirrored_albedo(
      coat_alpha, [](double cosine) { return fresnel_schlick(Coated<double>::kCoatReflectance, cosine); });
  sheen = make_sheen_layer(std::max(kMinSheenAlpha, sheen_roughness * sheen_roughness));
}

namespace {

template <class T>
using CoatedKernel = LobeKernel<Coated, T>;

}  // namespace

MaterialType coated_type() {
  return {"coated", "The glTF 2.0 material under fibres (sheen) and a clear coat.",
          make_material_set<Coated, CoatedKernel>};
}

}  // namespace orrery
