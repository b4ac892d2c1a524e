#include "core/params/params.h"
#include "core/shapes/primitive_set.h"

namespace orrery {
namespace {

template <class N>
struct Plane {
  Vec3<N> point, normal;

  static constexpr ShapeTraits kTraits = {.convex = true, .closed = false};

  static void read(Params& p, std::vector<Plane<double>>& out) {
    const Vec3d point = p.point("point", "Any point of the plane, in metres.");
    const Vec3d normal = p.direction("normal", "Direction that the front faces.");
    out.push_back({point, normal});
  }

  Boundsd bounds() const { return Boundsd::everything(); }

  // A ray along the plane never meets it: the quotient is then infinite or NaN, and neither is a hit.
  N distance(const Ray<N>& ray) const {
    using T = ScalarOf<N>;
    const N t = dot(point - ray.origin, normal) / dot(ray.direction, normal);
    return select(t > N(T(0)), t, N(std::numeric_limits<T>::infinity()));
  }

  Surface<N> surface(const Ray<N>& ray, const N& t) const {
    const Vec3<N> near = ray.at(t);
    const Vec3<N> position = near - normal * dot(near - point, normal);
    using std::max;
    return {position, normal, normal, max(max_component(abs(position)), max_component(abs(point)))};
  }
};

}  // namespace

ShapeType plane_type() { return {"plane", "An infinite flat surface.", make_shape_set<Plane>}; }

}  // namespace orrery
