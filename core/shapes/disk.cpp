#include "core/shapes/disk.h"

#include "core/params/params.h"
#include "core/shapes/primitive_set.h"

namespace orrery {

template <class N>
void Disk<N>::read(Params& p, std::vector<Disk<double>>& out) {
  const Vec3d center = p.point("center", "Centre, in metres.");
  const Vec3d normal = p.direction("normal", "Normal of the front side.");
  const double radius = p.positive("radius", "Radius, in metres.");
  out.push_back({center, normal, radius, max_component(abs(center)) + radius});
}

ShapeType disk_type() { return {"disk", "A flat disk.", make_shape_set<Disk>}; }

}  // namespace orrery
