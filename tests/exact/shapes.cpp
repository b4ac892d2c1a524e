#include "tests/exact/shapes.h"

#include <utility>

namespace orrery::exact {
namespace {

using OptionalRoot = std::optional<Root>;

void keep_nearer(OptionalRoot& nearest, Root t) {
  if (t.sign() > 0 && (!nearest || compare(t, *nearest) < 0)) nearest = std::move(t);
}

IVec from(const Ray& ray, const IVec& point) { return ray.origin - point * ray.w; }

// Returns the crossing of the ray with the plane through `point`, or nullopt if they are parallel.
OptionalRoot crossing(const Ray& ray, const IVec& point, const IVec& normal) {
  const Integer along = dot(ray.direction, normal);
  if (along == 0) return {};
  return Root::ratio(-dot(from(ray, point), normal), along);
}

// Returns the crossing point minus `point`, times w q. Requires t.s to be 0.
IVec offset(const Ray& ray, const Root& t, const IVec& point) {
  return from(ray, point) * t.q + ray.direction * t.p;
}

// Returns both roots of a t^2 + 2 b t + c. Returns nullopt if a is 0 or no root is real.
std::optional<std::pair<Root, Root>> quadratic(const Integer& a, const Integer& b, const Integer& c) {
  const Integer discriminant = b * b - a * c;
  if (a == 0 || discriminant < 0) return {};
  return std::pair{Root{-b, -1, discriminant, a}, Root{-b, 1, discriminant, a}};
}

OptionalRoot sphere(const Shape& s, const Ray& ray) {
  const IVec f = from(ray, s.a);
  const Integer r = s.radius * ray.w;
  const auto roots = quadratic(dot(ray.direction, ray.direction), dot(f, ray.direction), dot(f, f) - r * r);
  OptionalRoot nearest;
  if (roots) keep_nearer(nearest, roots->first), keep_nearer(nearest, roots->second);
  return nearest;
}

OptionalRoot plane(const Shape& s, const Ray& ray) {
  OptionalRoot nearest;
  if (const OptionalRoot t = crossing(ray, s.a, s.b)) keep_nearer(nearest, *t);
  return nearest;
}

OptionalRoot triangle(const Shape& s, const Ray& ray) {
  const IVec a = s.a * ray.w - ray.origin, b = s.b * ray.w - ray.origin, c = s.c * ray.w - ray.origin;
  const auto side = [&](const IVec& p, const IVec& q) { return sgn(dot(ray.direction, cross(p, q))); };
  const int ab = side(a, b), bc = side(b, c), ca = side(c, a);
  const bool inside = (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
  OptionalRoot nearest;
  if (!inside || (ab == 0 && bc == 0 && ca == 0)) return nearest;
  if (const OptionalRoot t = crossing(ray, s.a, cross(s.b - s.a, s.c - s.a))) keep_nearer(nearest, *t);
  return nearest;
}

OptionalRoot box(const Shape& s, const Ray& ray) {
  OptionalRoot nearest;
  for (int axis = 0; axis < 3; ++axis)
    for (const IVec* corner : {&s.a, &s.b}) {
      if (ray.direction[axis] == 0) continue;
      const Root t = Root::ratio((*corner)[axis] * ray.w - ray.origin[axis], ray.direction[axis]);
      const IVec above = offset(ray, t, s.a), below = offset(ray, t, s.b);
      bool inside = true;
      for (int other = 0; other < 3; ++other)
        inside = inside && (other == axis || (above[other] >= 0 && below[other] <= 0));
      if (inside) keep_nearer(nearest, t);
    }
  return nearest;
}

void round_plate(const Ray& ray, const IVec& center, const IVec& normal, const Integer& radius,
                 OptionalRoot& nearest) {
  const OptionalRoot t = crossing(ray, center, normal);
  if (!t) return;
  const IVec across = offset(ray, *t, center);
  const Integer reach = radius * ray.w * t->q;
  if (dot(across, across) <= reach * reach) keep_nearer(nearest, *t);
}

OptionalRoot disk(const Shape& s, const Ray& ray) {
  OptionalRoot nearest;
  round_plate(ray, s.a, s.b, s.radius, nearest);
  return nearest;
}

// Intersects finite and infinite cylinders. `s.b`: top of a finite cylinder, axis of an infinite cylinder.
OptionalRoot cylinder(const Shape& s, const Ray& ray) {
  const bool capped = s.kind == Shape::Kind::cylinder;
  const IVec axis = capped ? s.b - s.a : s.b;
  const IVec f = from(ray, s.a);
  // Components perpendicular to the axis, times the length of the axis.
  const IVec d_across = cross(ray.direction, axis), f_across = cross(f, axis);
  const Integer r = s.radius * ray.w;
  const auto roots = quadratic(dot(d_across, d_across), dot(f_across, d_across),
                               dot(f_across, f_across) - r * r * dot(axis, axis));
  OptionalRoot nearest;
  const auto keep = [&](const Root& t) {
    if (capped) {
      const Integer along = dot(ray.direction, axis);
      if (t.sign_of_line(dot(f, axis), along) < 0) return;
      if (t.sign_of_line(dot(from(ray, s.b), axis), along) > 0) return;
    }
    keep_nearer(nearest, t);
  };
  if (roots) keep(roots->first), keep(roots->second);
  if (capped) {
    round_plate(ray, s.a, axis, s.radius, nearest);
    round_plate(ray, s.b, axis, s.radius, nearest);
  }
  return nearest;
}

}  // namespace

std::optional<Root> nearest_root(const Shape& shape, const Ray& ray) {
  switch (shape.kind) {
    case Shape::Kind::sphere: return sphere(shape, ray);
    case Shape::Kind::plane: return plane(shape, ray);
    case Shape::Kind::triangle: return triangle(shape, ray);
    case Shape::Kind::box: return box(shape, ray);
    case Shape::Kind::disk: return disk(shape, ray);
    case Shape::Kind::cylinder:
    case Shape::Kind::infinite_cylinder: return cylinder(shape, ray);
  }
  return {};
}

}  // namespace orrery::exact
