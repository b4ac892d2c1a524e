#include "core/shapes/plane.h"

#include "core/params/params.h"
#include "core/shapes/primitive_set.h"

namespace orrery {

template <class N>
void Plane<N>::read(Params& p, std::vector<Plane<double>>& out) {
  const Vec3d point = p.point("point", "Any point on the plane, in metres.");
  const Vec3d normal = p.direction("normal", "Normal of the front side.");
  out.push_back({point, normal});
}

ShapeType plane_type() { return {"plane", "An infinite plane.", make_shape_set<Plane>}; }

}  // namespace orrery
