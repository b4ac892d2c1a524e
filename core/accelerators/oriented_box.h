#pragma once

#include "core/accelerators/single_ray.h"

namespace orrery {

// Sums over surfaces from which their principal axes follow: area, and integrals of x and x x^T. Sums of
// parts are those of the whole.
struct SurfaceMoments {
  double area = 0;
  Vec3d first;
  std::array<double, 6> second{};  // xx, yy, zz, xy, xz, yz

  void add(const HullTriangle& triangle);
  void add(const SurfaceMoments& other);
};

// Three unit vectors at right angles along which a surface spreads most and least: eigenvectors of its
// covariance, weighted by area so that how finely it is cut into triangles does not matter (Gottschalk, Lin,
// Manocha, "OBBTree", 1996). Surfaces without area get the axes of the world.
std::array<Vec3d, 3> principal_axes(const SurfaceMoments& moments);

// A box along axes of its own.
template <class T>
struct OrientedBox {
  Vec3<T> center;
  std::array<Vec3<T>, 3> axes;  // nearly at right angles: rounding is no matter, `box` is measured along them
  Bounds<T> box;                // of the differences from the center, padded for rounding

  // Around all corners of the hulls.
  static OrientedBox around(const std::array<Vec3d, 3>& axes, std::span<const HullTriangle> hull);

  double half_area() const {
    const Vec3d size = Vec3d(box.hi) - Vec3d(box.lo);
    return size.x * size.y + size.y * size.z + size.z * size.x;
  }
  double volume() const {
    const Vec3d size = Vec3d(box.hi) - Vec3d(box.lo);
    return size.x * size.y * size.z;
  }

  // Leaves what of from..to lies in the box; false if nothing does.
  bool clip(const Ray<T>& ray, T& from, T& to) const {
    return SingleProbe<T>({along(ray.origin - center), along(ray.direction)}).clip(box, from, to);
  }

 private:
  Vec3<T> along(const Vec3<T>& v) const { return {dot(axes[0], v), dot(axes[1], v), dot(axes[2], v)}; }
};

// The triangles of a box's sides.
std::vector<HullTriangle> sides_of(const Boundsd& box);

// The hull of a primitive.
template <class T>
std::vector<HullTriangle> hull_of(const Primitive<T>& primitive) {
  std::vector<HullTriangle> hull = primitive.kernel->hull(primitive.index);
  return hull.empty() ? sides_of(primitive.bounds) : hull;
}

// Whether the oriented box is so much smaller than the one along the axes that testing it as well pays: it
// takes three times as long.
template <class T>
bool oriented_pays(const OrientedBox<T>& oriented, const Bounds<T>& box) {
  constexpr double kShare = 0.7;
  const Vec3d size = Vec3d(box.hi) - Vec3d(box.lo);
  const double area = size.x * size.y + size.y * size.z + size.z * size.x;
  return oriented.half_area() < kShare * area && oriented.volume() <= size.x * size.y * size.z;
}

}  // namespace orrery
