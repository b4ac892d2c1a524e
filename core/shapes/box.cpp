#include "core/shapes/box.h"

#include "core/params/params.h"
#include "core/shapes/primitive_set.h"

namespace orrery {

template <class N>
void Box<N>::read(Params& p, std::vector<Box<double>>& out) {
  const Vec3d lo = p.point("min", "Corner with the smallest coordinates, in metres.");
  const Vec3d hi = p.point("max", "Corner with the largest coordinates, in metres.");
  if (!(lo.x < hi.x && lo.y < hi.y && lo.z < hi.z))
    p.fail("max", "must be larger than min in every coordinate");
  out.push_back({lo, hi, Boundsd::of({lo, hi}).magnitude()});
}

ShapeType box_type() { return {"box", "An axis-aligned box.", make_shape_set<Box>}; }

}  // namespace orrery
