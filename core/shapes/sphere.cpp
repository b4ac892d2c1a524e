#include "core/params/params.h"
#include "core/shapes/primitive_set.h"

namespace orrery {
namespace {

template <class N>
struct Sphere {
  Vec3<N> center;
  N radius;
  N magnitude;  // largest absolute coordinate on the sphere

  static constexpr ShapeTraits kTraits = {.convex = true, .closed = true};

  static void read(Params& p, std::vector<Sphere<double>>& out) {
    const Vec3d center = p.point("center", "Centre, in metres.");
    const double radius = p.positive("radius", "Radius, in metres.");
    out.push_back({center, radius, max_component(abs(center)) + radius});
  }

  Boundsd bounds() const { return Boundsd::around(center, Vec3d(radius)); }

  // The discriminant is taken from the part of origin - centre perpendicular to the ray, and the constant
  // term as a product: neither cancels when the origin is far away or close to a huge sphere (Haines,
  // Guenther, Akenine-Moeller, "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems, 2019).
  N distance(const Ray<N>& ray) const {
    using T = ScalarOf<N>;
    using std::sqrt;
    const N infinity(std::numeric_limits<T>::infinity());
    const Vec3<N> f = ray.origin - center;
    const N a = dot(ray.direction, ray.direction);
    const N b = -dot(f, ray.direction);
    const Vec3<N> residue = f + ray.direction * (b / a);
    const N discriminant = radius * radius - dot(residue, residue);
    const auto meets = discriminant >= N(T(0));
    if (!any(meets)) return infinity;
    const N root = sqrt(a * select(meets, discriminant, N(T(0))));
    const N q = b + select(b < N(T(0)), -root, root);
    const N distance_to_center = length(f);
    const N c = (distance_to_center - radius) * (distance_to_center + radius);
    const N t0 = c / q, t1 = q / a;
    const N first = min_first(t0, t1), second = max_first(t0, t1);
    const N nearest = select(first > N(T(0)), first, select(second > N(T(0)), second, infinity));
    return select(meets, nearest, infinity);
  }

  Surface<N> surface(const Ray<N>& ray, const N& t) const {
    const Vec3<N> normal = normalize(ray.at(t) - center);
    return {center + normal * radius, normal, normal, magnitude};
  }
};

}  // namespace

ShapeType sphere_type() {
  return {"sphere", "Points at one distance from a centre.", make_shape_set<Sphere>};
}

}  // namespace orrery
