#pragma once

#include "core/math/bounds.h"
#include "core/math/hemisphere.h"
#include "core/model/shape.h"

namespace orrery {

// Sphere data for the intersection test.
template <class N>
struct Ball {
  Vec3<N> center;
  N radius;

  // Returns the distance of the nearest hit ahead of the origin, or infinity for a miss. The discriminant
  // uses the part of origin - centre perpendicular to the ray, and the constant term is a product. Neither
  // cancels if the origin is far away or close to a huge sphere (Haines, Guenther, Akenine-Moeller,
  // "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems, 2019).
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

  // Returns false for spheres that no active ray of the packet can hit. x, y and z are coordinates of the
  // centre in the axes of the packet, relative to the rays' origin. At depth z, the centre is at an offset of
  // x - shear * z from a ray. The ray misses if the offset exceeds the radius divided by the cosine of the
  // angle between ray and z axis. The packet misses if this is true, on the same side, for both ends of its
  // range of shears. y is tested in the same way. The radius is padded for the rounding of the offset.
  MaskOf<N> may_meet(const Packet<ScalarOf<N>>& packet) const {
    using T = ScalarOf<N>;
    if (!packet.one_origin) return MaskOf<N>(true);
    const auto at = [&](std::size_t axis) { return center[axis] - N(packet.origin[axis]); };
    const auto [x_axis, y_axis, z_axis] = packet.axis;
    const N x = at(x_axis), y = at(y_axis), z = at(z_axis);
    const auto steepest = [&](std::size_t side) {
      return std::max(std::abs(packet.shear_lo[side]), std::abs(packet.shear_hi[side]));
    };
    const T sx = steepest(0), sy = steepest(1);
    constexpr T kRounding = 32 * std::numeric_limits<T>::epsilon();
    const N grown = radius + max_component(abs(Vec3<N>(x, y, z))) * N(kRounding);
    const N reach = grown * N(std::sqrt(1 + sx * sx + sy * sy) * (1 + kRounding));
    const auto misses_side = [&](const N& v, std::size_t side) {
      const N lo = v - N(packet.shear_lo[side]) * z, hi = v - N(packet.shear_hi[side]) * z;
      return min_first(lo, hi) > reach || max_first(lo, hi) < -reach;
    };
    return !misses_side(x, 0) && !misses_side(y, 1);
  }
};

template <class N>
struct Sphere {
  Ball<N> ball;
  N magnitude;  // largest absolute coordinate on the sphere

  static constexpr ShapeTraits kTraits = {.convex = true, .closed = true};

  static void read(Params& p, std::vector<Sphere<double>>& out);
  void tessellate(const TessellationView& view, int primitive, Tessellation& out) const;

  Boundsd bounds() const { return Boundsd::around(ball.center, Vec3d(ball.radius)); }

  Patch patch() const { return {Patch::Kind::sphere, ball.center, Vec3d(ball.radius), {}}; }

  using Core = Ball<N>;
  const Core& core() const { return ball; }
  N distance(const Ray<N>& ray) const { return ball.distance(ray); }

  Surface<N> surface(const Ray<N>& ray, const N& t) const {
    const Vec3<N> normal = normalize(ray.at(t) - ball.center);
    return {ball.center + normal * ball.radius, normal, normal, magnitude};
  }

  // u is the angle around the y axis in turns, in [0, 1], from +x, anticlockwise as seen from above. v rises
  // linearly with latitude from 0 at the bottom to 1 at the top.
  SurfacePoint<N> parameters(const Ray<N>&, const Vec3<N>& position) const {
    using T = ScalarOf<N>;
    using std::sqrt;
    const Vec3<N> p = position - ball.center;
    const N across = sqrt(p.x * p.x + p.z * p.z), zero(T(0));
    const N u = positive_turns(p.x, N(-p.z)), v = T(0.5) + T(2) * direction_turns(across, p.y);
    const auto pole = !(across > zero);
    const Vec3<N> tangent(select(pole, N(T(1)), N(p.z / across)), zero, select(pole, zero, N(-p.x / across)));
    return {u, v, u, v, tangent};
  }
};

}  // namespace orrery
