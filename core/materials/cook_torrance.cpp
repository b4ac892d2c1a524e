#include "core/materials/cook_torrance.h"

#include "core/params/params.h"

namespace orrery {

template <class N>
CookTorrance<double> CookTorrance<N>::read(Params& p) {
  const Vec3d n = p.color("n", "Index of refraction of the facets, per channel.", Vec3d(1.5));
  const Vec3d k = p.color("k", "Extinction coefficient of the facets, per channel.", Vec3d(0));
  const Vec3d diffuse = p.coefficient("diffuse", "Diffuse reflectance, 0 to 1 per channel.", Vec3d(0), 1);
  const Vec3d specular =
      p.coefficient("specular", "Weight of the facet reflection, 0 to 1 per channel; default: 1 - diffuse.",
                    Vec3d(1) - diffuse, 1);
  const double slope = p.number("slope", "RMS slope of the facets.", {.min = 0.01, .max = 1}, 0.3);
  const double most = max_component(diffuse + specular);
  if (most > 1)
    p.fail("specular",
           "specular + diffuse must be at most 1 in every channel (got " + number_text(most) + ")");
  CookTorrance<double> found{n, k, diffuse, specular, slope, 0};
  found.chance = lobe_chance(max_component(specular * found.reflectance(0.7)), max_component(diffuse));
  return found;
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
