#include "core/shapes/triangle.h"

#include "core/math/face_normal.h"
#include "core/model/tessellation.h"
#include "core/params/params.h"
#include "core/shapes/primitive_set.h"

namespace orrery {

template <class N>
void Triangle<N>::read(Params& p, std::vector<Triangle<double>>& out) {
  std::vector<Vec3d> v =
      p.points("vertices", "Three vertices in metres, anticlockwise as seen from the front.", {3, 3});
  v.resize(3);
  const Vec3d normal = face_normal(v[0], v[1], v[2]);
  if (normal == Vec3d()) p.fail("vertices", "must be three points that are not collinear");
  out.push_back({{v[0], v[1], v[2]}, normal, Boundsd::of({v[0], v[1], v[2]}).magnitude()});
}

template <class N>
void Triangle<N>::tessellate(const TessellationView&, int primitive, Tessellation& out) const {
  out.add(primitive, out.add(corners.a), out.add(corners.b), out.add(corners.c));
}

ShapeType triangle_type() { return {"triangle", "A flat triangle.", make_shape_set<Triangle>}; }

}  // namespace orrery
