#include "core/shapes/torus.h"

#include "core/params/params.h"
#include "core/shapes/primitive_set.h"

namespace orrery {

template <class N>
void Torus<N>::read(Params& p, std::vector<Torus<double>>& out) {
  const Vec3d center = p.point("center", "Centre, in metres.");
  const Vec3d axis = p.direction("axis", "Direction of the axis of symmetry.");
  const double major = p.positive("major_radius", "Radius of the circle inside the tube, in metres.");
  const double minor =
      p.positive("minor_radius", "Radius of the tube, in metres. Must be less than major_radius.");
  if (minor >= major) p.fail("minor_radius", "must be less than major_radius");
  out.push_back({center, axis, major, minor, max_component(abs(center)) + major + minor});
}

ShapeType torus_type() { return {"torus", "A ring with a round tube.", make_shape_set<Torus>}; }

}  // namespace orrery
