#pragma once

#include "core/accelerators/single_ray.h"

namespace orrery {

// Area of a surface, and the integrals of x and x x^T over all points x of the surface. They determine the
// principal axes. The moments of a surface are the sums of the moments of its parts.
struct SurfaceMoments {
  double area = 0;
  Vec3d first;
  std::array<double, 6> second{};  // xx, yy, zz, xy, xz, yz

  void add(const HullTriangle& triangle);
  void add(const SurfaceMoments& other);
};

// Returns the principal axes of a surface: three orthogonal unit eigenvectors of the covariance of its
// points. Weighting by area makes them independent of the tessellation (Gottschalk, Lin, Manocha, "OBBTree",
// 1996). Returns the world axes if the area is 0.
std::array<Vec3d, 3> principal_axes(const SurfaceMoments& moments);

// Oriented bounding box.
template <class T>
struct OrientedBox {
  Vec3<T> center;
  std::array<Vec3<T>, 3> axes;  // nearly orthogonal unit vectors; `box` is measured along the rounded axes
  Bounds<T> box;                // relative to the center, padded for rounding

  // Returns the oriented box along `axes` that contains all corners of the triangles.
  static OrientedBox around(const std::array<Vec3d, 3>& axes, std::span<const HullTriangle> hull);

  double half_area() const {
    const Vec3d size = Vec3d(box.hi) - Vec3d(box.lo);
    return size.x * size.y + size.y * size.z + size.z * size.x;
  }
  double volume() const {
    const Vec3d size = Vec3d(box.hi) - Vec3d(box.lo);
    return size.x * size.y * size.z;
  }

  // Clips [from, to] to the box. Returns false if the interval becomes empty.
  bool clip(const Ray<T>& ray, T& from, T& to) const {
    return RayBoxTester<T>({along(ray.origin - center), along(ray.direction)}).clip(box, from, to);
  }

 private:
  Vec3<T> along(const Vec3<T>& v) const { return {dot(axes[0], v), dot(axes[1], v), dot(axes[2], v)}; }
};

// Returns the triangles of the box's six sides.
std::vector<HullTriangle> sides_of(const Boundsd& box);

// Returns the hull of a primitive, or of its box if it has no hull.
template <class T>
std::vector<HullTriangle> hull_of(const Primitive<T>& primitive) {
  std::vector<HullTriangle> hull = primitive.kernel->hull(primitive.index);
  return hull.empty() ? sides_of(primitive.bounds) : hull;
}

// Returns whether the oriented box is small enough to justify its test, which takes three times as long as
// the test of an axis-aligned box.
template <class T>
bool oriented_pays(const OrientedBox<T>& oriented, const Bounds<T>& box) {
  constexpr double kShare = 0.7;
  const Vec3d size = Vec3d(box.hi) - Vec3d(box.lo);
  const double area = size.x * size.y + size.y * size.z + size.z * size.x;
  return oriented.half_area() < kShare * area && oriented.volume() <= size.x * size.y * size.z;
}

}  // namespace orrery
