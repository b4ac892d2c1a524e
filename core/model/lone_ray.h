#pragma once

#include <array>

#include "core/math/bounds.h"
#include "core/model/batch.h"

namespace orrery {

// One ray alone among many primitives, with what is worth working out once for all of them.
template <class T>
struct LoneRay {
  Vec3<T> origin, direction;
  Vec3<T> inverse;            // of the direction; finite, see finite_inverse()
  std::array<int, 3> axis;    // axis[2]: the direction's largest component, the others follow it cyclically
  T shear_x, shear_y, along;  // direction[axis[0]] / along, direction[axis[1]] / along, direction[axis[2]]
};

// Nearest hit so far: t starts as the ray's t_max, primitive as kNoPrimitive.
template <class T>
struct LoneHit {
  T t;
  IndexOf<T> primitive;
};

// 1 / direction, where a component that is 0, or next to it, counts as so small a one that the ray leaves no
// box sideways: no infinity arises.
template <class N>
[[gnu::always_inline]] inline Vec3<N> finite_inverse(const Vec3<N>& direction) {
  using T = ScalarOf<N>;
  const N least = max_component(abs(direction)) * T(1e-18);
  const auto invert = [&least](const N& d) {
    using std::abs, std::signbit;
    return N(T(1) / select(abs(d) < least, select(signbit(d), -least, least), d));
  };
  return {invert(direction.x), invert(direction.y), invert(direction.z)};
}

// The axes of a ray as masks: z the direction's largest component, x and y following it cyclically.
template <class N>
struct RayAxes {
  MaskOf<N> z_is_x, z_is_y, z_is_z;

  [[gnu::always_inline]] explicit RayAxes(const Vec3<N>& direction) {
    const Vec3<N> size = abs(direction);
    z_is_x = size.x >= size.y && size.x >= size.z;
    z_is_y = !z_is_x && size.y >= size.z;
    z_is_z = !z_is_x && !z_is_y;
  }
  [[gnu::always_inline]] N x(const Vec3<N>& v) const { return select(z_is_z, v.x, select(z_is_x, v.y, v.z)); }
  [[gnu::always_inline]] N y(const Vec3<N>& v) const { return select(z_is_y, v.x, select(z_is_z, v.y, v.z)); }
  [[gnu::always_inline]] N z(const Vec3<N>& v) const { return select(z_is_x, v.x, select(z_is_y, v.y, v.z)); }
};

// The rays of a register one by one; they are made ready together.
template <class T>
class LoneRays {
 public:
  explicit LoneRays(const Ray<Lanes<T>>& rays) {
    using N = Lanes<T>;
    const RayAxes<N> axes(rays.direction);
    const N along = axes.z(rays.direction);
    put(0, rays.origin);
    put(3, rays.direction);
    put(6, finite_inverse(rays.direction));
    put(9, {axes.x(rays.direction) / along, axes.y(rays.direction) / along, along});
    largest_ = select(axes.z_is_x, N(T(0)), select(axes.z_is_y, N(T(1)), N(T(2))));
  }

  LoneRay<T> operator[](int i) const {
    const auto lane = static_cast<std::size_t>(i);
    const auto vector = [&](std::size_t row) {
      return Vec3<T>(rows_[row][lane], rows_[row + 1][lane], rows_[row + 2][lane]);
    };
    static constexpr std::array<std::array<int, 3>, 3> kCyclic{{{1, 2, 0}, {2, 0, 1}, {0, 1, 2}}};
    return {
        vector(0),      vector(3),       vector(6),      kCyclic[static_cast<std::size_t>(T(largest_[lane]))],
        rows_[9][lane], rows_[10][lane], rows_[11][lane]};
  }

 private:
  void put(std::size_t row, const Vec3<Lanes<T>>& v) {
    rows_[row] = v.x;
    rows_[row + 1] = v.y;
    rows_[row + 2] = v.z;
  }
  std::array<Lanes<T>, 12> rows_;
  Lanes<T> largest_;
};

}  // namespace orrery
