#include "core/shapes/cylinder.h"

#include "core/params/params.h"
#include "core/shapes/primitive_set.h"

namespace orrery {

template <class N>
void Cylinder<N>::read(Params& p, std::vector<Cylinder<double>>& out) {
  const double infinity = std::numeric_limits<double>::infinity();
  if (p.form({{"base", "top"}, {"point", "axis"}}) == 0) {
    const Vec3d base = p.point("base", "Centre of one cap, in metres.");
    const Vec3d top = p.point("top", "Centre of the other cap, in metres.");
    const double radius = p.positive("radius", "Radius, in metres.");
    if (base == top) p.fail("top", "must differ from base");
    const double reach = std::max(max_component(abs(base)), max_component(abs(top))) + radius;
    out.push_back({(base + top) * 0.5, safe_normalize(top - base), radius, length(top - base) / 2, reach});
  } else {
    const Vec3d point = p.point("point", "Any point on the axis, in metres.");
    const Vec3d axis = p.direction("axis", "Direction of the axis of an infinite cylinder.");
    const double radius = p.positive("radius", "Radius, in metres.");
    out.push_back({point, axis, radius, infinity, max_component(abs(point)) + radius});
  }
}

ShapeType cylinder_type() {
  return {"cylinder", "A circular cylinder, with caps or infinitely long.", make_shape_set<Cylinder>};
}

}  // namespace orrery
