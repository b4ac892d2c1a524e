#include "core/materials/oren_nayar.h"

#include "core/materials/diffuse.h"
#include "core/params/params.h"

namespace orrery {

template <>
void OrenNayarInputs<double>::read(MaterialParams& p) {
  p.coefficient(reflectance, "reflectance", "Reflectance of a facet, 0 to 1 per channel.", Vec3d(0.8), 1);
  p.number(roughness, "roughness", "Roughness from 0 (equal to lambert) to 1.", {.min = 0, .max = 1}, 0.5);
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
