#include "core/params/params.h"
#include "core/shapes/primitive_set.h"
#include "core/shapes/round_hull.h"

namespace orrery {
namespace {

template <class N>
struct Disk {
  Vec3<N> center, normal;
  N radius;
  N magnitude;  // largest absolute coordinate, at most

  static constexpr ShapeTraits kTraits = {.convex = true, .closed = false};

  static void read(Params& p, std::vector<Disk<double>>& out) {
    const Vec3d center = p.point("center", "Centre, in metres.");
    const Vec3d normal = p.direction("normal", "Direction that the front faces.");
    const double radius = p.positive("radius", "Radius, in metres.");
    out.push_back({center, normal, radius, max_component(abs(center)) + radius});
  }

  Boundsd bounds() const {
    const auto reach = [&](double n) { return radius * std::sqrt(std::max(0.0, 1 - n * n)); };
    return Boundsd::around(center, {reach(normal.x), reach(normal.y), reach(normal.z)});
  }

  std::vector<HullTriangle> hull() const {
    return round_hull(Vec3d(center), Vec3d(normal), double(radius), 0);
  }

  N distance(const Ray<N>& ray) const {
    using T = ScalarOf<N>;
    const N t = dot(center - ray.origin, normal) / dot(ray.direction, normal);
    const Vec3<N> from_center = ray.at(t) - center;
    const auto inside = dot(from_center, from_center) <= radius * radius;
    return select(t > N(T(0)) && inside, t, N(std::numeric_limits<T>::infinity()));
  }

  Surface<N> surface(const Ray<N>& ray, const N& t) const {
    const Vec3<N> near = ray.at(t);
    return {near - normal * dot(near - center, normal), normal, normal, magnitude};
  }
};

}  // namespace

ShapeType disk_type() { return {"disk", "A flat round plate.", make_shape_set<Disk>}; }

}  // namespace orrery
