#include "core/materials/cook_torrance.h"

#include "core/params/params.h"

namespace orrery {

template <>
void CookTorranceInputs<double>::read(MaterialParams& p) {
  p.color(n, "n", "Index of refraction of the facets, per channel.", Vec3d(1.5));
  p.color(k, "k", "Extinction coefficient of the facets, per channel.", Vec3d(0));
  p.coefficient(diffuse, "diffuse", "Diffuse reflectance, 0 to 1 per channel.", Vec3d(0), 1);
  p.coefficient_like(specular, "specular",
                     "Weight of the facet reflection, 0 to 1 per channel; default: 1 - diffuse.", diffuse, -1,
                     1, 1);
  p.number(slope, "slope", "RMS slope of the facets.", {.min = 0.01, .max = 1}, 0.3);
  const bool follows = !p.plain().has("specular");
  const double most = max_component(p.most(diffuse) + p.most(specular));
  if (most > 1 && !follows)
    p.plain().fail("specular",
                   "specular + diffuse must be at most 1 in every channel (got " + number_text(most) + ")");
}

namespace {

template <class T>
using CookTorranceKernel = LobeKernel<CookTorrance, T>;

}  // namespace

MaterialType cook_torrance_type() {
  return {"cook-torrance", "Microfacet reflection plus a diffuse lobe (Cook, Torrance 1982).",
          make_material_set<CookTorrance, CookTorranceKernel>};
}

}  // namespace orrery
