#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/accelerators/box_testers.h"

namespace orrery {

using CellIndex = std::array<int, 3>;

// Box divided into equal cells. Planes are computed from their indices alone, so rounding errors do not
// accumulate.
template <class T>
class GridLayout {
 public:
  // Divides the box into about `cells` cells, with at most 1,024 cells along an axis. The cells are nearly
  // cubic unless the box is too thin.
  GridLayout(const Bounds<T>& box, double cells) : box_(box), count_(sides_for(box.hi - box.lo, cells)) {
    constexpr T kWider = 1 + 4 * std::numeric_limits<T>::epsilon();  // keeps the last plane outside the box
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const T extent = box.hi[axis] - box.lo[axis];
      T& size = size_[axis];
      size = extent / static_cast<T>(count_[axis]) * kWider;
      per_size_[axis] = size > 0 ? 1 / size : 0;
    }
  }

  const Bounds<T>& box() const { return box_; }
  int count(std::size_t axis) const { return count_[axis]; }
  std::size_t cells() const { return number({0, 0, count_[2]}); }
  std::size_t number(const CellIndex& i) const {
    return (static_cast<std::size_t>(i[2]) * static_cast<std::size_t>(count_[1]) +
            static_cast<std::size_t>(i[1])) *
               static_cast<std::size_t>(count_[0]) +
           static_cast<std::size_t>(i[0]);
  }
  // Returns the plane between layers i - 1 and i.
  T plane(std::size_t axis, int i) const { return box_.lo[axis] + size_[axis] * static_cast<T>(i); }
  Bounds<T> cell(const CellIndex& i) const {
    return {{plane(0, i[0]), plane(1, i[1]), plane(2, i[2])},
            {plane(0, i[0] + 1), plane(1, i[1] + 1), plane(2, i[2] + 1)}};
  }

  // Calls visit(index) for each cell that touches the box.
  template <class Visit>
  void for_each_touching(const Bounds<T>& box, const Visit& visit) const {
    const auto [x0, x1] = touching(0, box.lo.x, box.hi.x);
    const auto [y0, y1] = touching(1, box.lo.y, box.hi.y);
    const auto [z0, z1] = touching(2, box.lo.z, box.hi.z);
    for (int z = z0; z <= z1; ++z)
      for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) visit(CellIndex{x, y, z});
  }

  // Calls visit(index, near, far) for the cells that the ray may touch in [from, to], from near to far. The
  // ray is in the cell from distance `near` to `far`. Stops when open(near) returns false. Steps through
  // layers along the main axis, rows in each layer and cells in each row (after Amanatides and Woo, "A Fast
  // Voxel Traversal Algorithm for Ray Tracing", 1987). If the ray is close to a plane, visits the cells on
  // both sides.
  template <class Open, class Visit>
  void for_each_along(const SingleRay<T>& ray, const RayBoxTester<T>& probe, T from, T to, const Open& open,
                      const Visit& visit) const {
    if (!probe.clip(box_, from, to)) return;
    const int x = ray.axis[0], y = ray.axis[1], z = ray.axis[2];
    const T rounding = kRounding<T> * (box_.magnitude() + max_component(abs(ray.ray.origin)));
    const auto layers = [&](int axis, T first, T last, const auto& enter) {
      along(ray.ray, probe, static_cast<std::size_t>(axis), rounding, first, last, open, enter);
    };
    CellIndex i;
    const auto at = [&i](int axis) -> int& { return i[static_cast<std::size_t>(axis)]; };
    layers(z, from, to, [&](int iz, T from_z, T to_z) {
      at(z) = iz;
      layers(y, from_z, to_z, [&](int iy, T from_y, T to_y) {
        at(y) = iy;
        layers(x, from_y, to_y, [&](int ix, T from_x, T to_x) {
          at(x) = ix;
          visit(i, from_x, to_x);
        });
      });
    });
  }

 private:
  static CellIndex sides_for(const Vec3<T>& extent, double cells) {
    constexpr double kMaxPerSide = 1024;
    CellIndex count{1, 1, 1};
    std::array<bool, 3> thin{};
    for (int pass = 0; pass < 3; ++pass) {
      double volume = 1, axes = 0;
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (!thin[axis]) volume *= double{extent[axis]}, ++axes;
      const double side = axes > 0 ? std::pow(volume / cells, 1 / axes) : 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double fit = side > 0 ? double{extent[axis]} / side : 0;
        thin[axis] = thin[axis] || !(fit >= 1);
        count[axis] = thin[axis] ? 1 : static_cast<int>(std::min(std::round(fit), kMaxPerSide));
      }
    }
    return count;
  }

  // Returns the index of the layer at a distance of `layers` cells from the low side, clamped to the grid.
  int layer(std::size_t axis, T layers) const {
    const T last = static_cast<T>(count_[axis] - 1);
    return layers > 0 ? static_cast<int>(std::min(layers, last)) : 0;
  }

  // Returns the first and the last layer that touch [lo, hi].
  std::array<int, 2> touching(std::size_t axis, T lo, T hi) const {
    const T from = box_.lo[axis], per = per_size_[axis];
    int i = layer(axis, (lo - from) * per), j = layer(axis, (hi - from) * per);
    while (i > 0 && plane(axis, i) >= lo) --i;
    while (i + 1 < count_[axis] && plane(axis, i + 1) < lo) ++i;
    while (j + 1 < count_[axis] && plane(axis, j + 1) <= hi) ++j;
    while (j > 0 && plane(axis, j) > hi) --j;
    return {i, j};
  }

  template <class Open, class Visit>
  void along(const Ray<T>& ray, const RayBoxTester<T>& probe, std::size_t axis, T rounding, T from, T to,
             const Open& open, const Visit& visit) const {
    const bool down = probe.descending(axis);
    const T per = per_size_[axis], slack = T(0.001) + rounding * per;
    const T begin = (ray.origin[axis] + ray.direction[axis] * from - box_.lo[axis]) * per;
    const int step = down ? -1 : 1, end = down ? -1 : count_[axis];
    for (int i = layer(axis, down ? begin + slack : begin - slack); i != end; i += step) {
      T near = from, far = to;
      probe.clip(axis, plane(axis, i), plane(axis, i + 1), near, far);
      if (near > to || !open(near)) return;
      if (near <= far) visit(i, near, far);
    }
  }

  Bounds<T> box_;
  Vec3<T> size_, per_size_;  // cell size and its reciprocal; both 0 on an axis along which the box is flat
  CellIndex count_;
};

}  // namespace orrery
