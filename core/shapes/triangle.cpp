#include "core/params/params.h"
#include "core/shapes/primitive_set.h"
#include "core/shapes/triangle_hit.h"

namespace orrery {
namespace {

template <class N>
struct Triangle {
  Corners<N> corners;
  Vec3<N> normal;  // by the right-hand rule over a, b, c
  N magnitude;     // largest absolute coordinate

  static constexpr ShapeTraits kTraits = {.convex = true, .closed = false};

  static void read(Params& p, std::vector<Triangle<double>>& out) {
    std::vector<Vec3d> v =
        p.points("vertices", "The three vertices, in metres; anticlockwise from the front.", {3, 3});
    v.resize(3);
    const Vec3d normal = safe_normalize(cross(v[1] - v[0], v[2] - v[0]));
    if (normal == Vec3d()) p.fail("vertices", "expected three vertices that are not on one line");
    out.push_back({{v[0], v[1], v[2]}, normal, Boundsd::of({v[0], v[1], v[2]}).magnitude()});
  }

  Boundsd bounds() const { return corners.bounds(); }
  std::vector<HullTriangle> hull() const { return corners.hull(); }

  using Core = Corners<N>;
  const Core& core() const { return corners; }
  N distance(const Ray<N>& ray) const { return corners.distance(ray); }

  Surface<N> surface(const Ray<N>& ray, const N&) const {
    return {corners.mix(corners.weights(ray)), normal, normal, magnitude};
  }
};

}  // namespace

ShapeType triangle_type() {
  return {"triangle", "Three vertices and the flat surface between them.", make_shape_set<Triangle>};
}

}  // namespace orrery
