#include "core/materials/lambert.h"

#include "core/materials/diffuse.h"
#include "core/params/params.h"

namespace orrery {

template <>
void Lambert<double>::read(MaterialParams& p) {
  p.coefficient(reflectance, "reflectance", "Diffuse reflectance, 0 to 1 per channel.", Vec3d(0.8), 1);
}

namespace {

template <class T>
using LambertKernel = DiffuseKernel<Lambert, T>;

}  // namespace

MaterialType lambert_type() {
  return {"lambert", "A Lambertian (ideal diffuse) surface.", make_material_set<Lambert, LambertKernel>};
}

}  // namespace orrery
