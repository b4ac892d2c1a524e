#include "core/shapes/sphere.h"

#include "core/params/params.h"
#include "core/shapes/primitive_set.h"

namespace orrery {

template <class N>
void Sphere<N>::read(Params& p, std::vector<Sphere<double>>& out) {
  const Vec3d center = p.point("center", "Centre, in metres.");
  const double radius = p.positive("radius", "Radius, in metres.");
  out.push_back({{center, radius}, max_component(abs(center)) + radius});
}

ShapeType sphere_type() { return {"sphere", "A sphere.", make_shape_set<Sphere>}; }

}  // namespace orrery
