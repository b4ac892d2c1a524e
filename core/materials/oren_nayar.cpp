#include "core/materials/oren_nayar.h"

#include "core/materials/diffuse.h"
#include "core/params/params.h"

namespace orrery {

// Multiple scattering reflects the fraction rho^2 E / (1 - rho (1 - E)), the sum over all bounces between
// facets. rho is the reflectance of a facet. E is the mean albedo of white facets.
template <class N>
OrenNayar<double> OrenNayar<N>::read(Params& p) {
  const Vec3d reflectance =
      p.coefficient("reflectance", "Reflectance of a facet, 0 to 1 per channel.", Vec3d(0.8), 1);
  const double roughness =
      p.number("roughness", "Roughness from 0 (equal to lambert) to 1.", {.min = 0, .max = 1}, 0.5);
  const double a = 1 / (1 + kFujii * roughness), mean = a * (1 + kMeanG * roughness);
  const auto multiple = [&](double rho) {
    return rho * rho * mean / (1 - rho * (1 - mean)) * (a * roughness / (kFujii - kMeanG));
  };
  return {reflectance, roughness, a,
          Vec3d(multiple(reflectance.x), multiple(reflectance.y), multiple(reflectance.z))};
}

namespace {

template <class T>
using OrenNayarKernel = DiffuseKernel<OrenNayar, T>;

}  // namespace

MaterialType oren_nayar_type() {
  return {"oren-nayar", "A diffuse surface of rough facets, such as clay or plaster.",
          make_material_set<OrenNayar, OrenNayarKernel>};
}

}  // namespace orrery
