#pragma once

#include <array>
#include <cmath>

#include "core/math/bounds.h"
#include "core/math/compress.h"
#include "core/model/packet.h"

// Box testers: slab tests of a ray (RayBoxTester) or packet (PacketBoxTester) against all children of a wide
// node. A tester stores the data that are computed once per ray or packet.
//
// Box tests are conservative: they accept every box that contains a hit found by the rounded intersection
// tests. padded() enlarges boxes for the rounding of their contents. A tester also moves the planes of each
// axis outward by kRounding times the largest absolute coordinate of the ray origins, and multiplies far
// distances by kFarther. This covers the rounding of distances in the slab test (Ize, "Robust BVH Ray
// Traversal", JCGT 2013) and in the intersection tests.
namespace orrery {

// Factor that enlarges far distances in slab tests.
template <class T>
inline constexpr T kFarther = 1 + 8 * std::numeric_limits<T>::epsilon();

// Boxes of a node's children, one per lane: planes[2 * axis] are the low sides, planes[2 * axis + 1] the high
// sides.
template <class T>
using BoxPlanes = std::array<Lanes<T>, 6>;

// Return the maximum and the minimum over the active lanes. REQUIRES: any(active).
template <class N>
inline ScalarOf<N> largest(const MaskOf<N>& active, const N& v) {
  return stdx::hmax(select(active, v, N(-std::numeric_limits<ScalarOf<N>>::infinity())));
}
template <class N>
inline ScalarOf<N> smallest(const MaskOf<N>& active, const N& v) {
  return stdx::hmin(select(active, v, N(std::numeric_limits<ScalarOf<N>>::infinity())));
}

// Box tester of one ray.
template <class T>
class RayBoxTester {
 public:
  using N = Lanes<T>;

  // Data of all rays of a register, from which the testers of its lanes are made.
  struct Register {
    using Array = std::array<T, static_cast<std::size_t>(kWidth<T>)>;
    struct Axis {
      alignas(64) Array inverse, near_offset, far_offset;
      unsigned descending;  // one bit per lane
    };
    std::array<Axis, 3> axis;

    [[gnu::always_inline]] explicit Register(const Ray<N>& rays) {
      const N pad = max_component(abs(rays.origin)) * kRounding<T>;
      const N least = max_component(abs(rays.direction)) * T(1e-18);
      for (std::size_t i = 0; i < 3; ++i) {
        using std::abs;
        const N zero(T(0));
        const N direction = select(abs(rays.direction[i]) < least,
                                   select(rays.direction[i] < zero, N(-least), least), rays.direction[i]);
        const N inverse = N(T(1)) / direction, middle = rays.origin[i] * inverse, reach = pad * abs(inverse);
        inverse.copy_to(axis[i].inverse.data(), stdx::vector_aligned);
        N(middle + reach).copy_to(axis[i].near_offset.data(), stdx::vector_aligned);
        N(middle - reach).copy_to(axis[i].far_offset.data(), stdx::vector_aligned);
        axis[i].descending = bits_of(inverse < zero);
      }
    }
  };
  RayBoxTester(const Register& rays, std::size_t lane) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& axis = rays.axis[i];
      near_[i] = 2 * i + (axis.descending >> lane & 1u);
      inverse_[i] = axis.inverse[lane];
      near_offset_[i] = axis.near_offset[lane];
      far_offset_[i] = axis.far_offset[lane];
    }
  }

  explicit RayBoxTester(const Ray<T>& ray) {
    const T pad = max_component(abs(ray.origin)) * kRounding<T>;
    const T least = max_component(abs(ray.direction)) * T(1e-18);
    set(0, ray.origin.x, ray.direction.x, pad, least);
    set(1, ray.origin.y, ray.direction.y, pad, least);
    set(2, ray.origin.z, ray.direction.z, pad, least);
  }

  // Returns the octant of the direction: bit i is set if component i is negative.
  std::uint8_t octant() const {
    return static_cast<std::uint8_t>((near_[0] & 1) | (near_[1] & 1) << 1 | (near_[2] & 1) << 2);
  }

  // Stores the entry distance of each box in `near`. Returns one bit per box, set if the ray enters the box
  // before `limit`.
  [[gnu::always_inline]] unsigned enter(const BoxPlanes<T>& planes, T limit, N& near) const {
    near = N(T(0));
    N far = N(limit);
#pragma GCC unroll 3
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const N inverse(inverse_[axis]);
      near = max_first(near, multiply_subtract(planes[near_[axis]], inverse, N(near_offset_[axis])));
      far = min_first(far, multiply_subtract(planes[near_[axis] ^ 1], inverse, N(far_offset_[axis])));
    }
    return bits_of(near <= far * kFarther<T>);
  }

  bool descending(std::size_t axis) const { return (near_[axis] & 1) != 0; }
  // Return the smallest and the largest distance at which the ray may cross a plane perpendicular to an axis.
  T earliest(std::size_t axis, T plane) const { return plane * inverse_[axis] - near_offset_[axis]; }
  T latest(std::size_t axis, T plane) const { return plane * inverse_[axis] - far_offset_[axis]; }
  // Clips [from, to] to the box. Returns false if the interval becomes empty.
  bool clip(const Bounds<T>& box, T& from, T& to) const {
    for (std::size_t axis = 0; axis < 3; ++axis) clip(axis, box.lo[axis], box.hi[axis], from, to);
    return from <= to;
  }
  void clip(std::size_t axis, T lo, T hi, T& from, T& to) const {
    from = max_first(from, earliest(axis, descending(axis) ? hi : lo));
    to = min_first(to, T(latest(axis, descending(axis) ? lo : hi) * kFarther<T>));
  }

 private:
  // Sets the data of one axis. A direction component smaller than `least` is replaced by `least` with the
  // same sign, so that its reciprocal is finite. The padding of the boxes exceeds the displacement of the
  // ray.
  void set(std::size_t axis, T origin, T direction, T pad, T least) {
    if (std::abs(direction) < least) direction = std::copysign(least, direction);
    const T inverse = 1 / direction;
    near_[axis] = 2 * axis + (inverse < 0);
    inverse_[axis] = inverse;
    near_offset_[axis] = origin * inverse + pad * std::abs(inverse);
    far_offset_[axis] = origin * inverse - pad * std::abs(inverse);
  }

  std::array<std::size_t, 3> near_;
  std::array<T, 3> inverse_, near_offset_, far_offset_;
};

// Box tester of a packet, computed from the intervals of its origins and directions.
template <class T>
class PacketBoxTester {
 public:
  using N = Lanes<T>;

  // Makes a tester of the `active` rays. REQUIRES: any(active).
  PacketBoxTester(const Ray<N>& rays, const MaskOf<N>& active) {
    std::array<Interval, 3> origin, direction;
    T pad = 0, size = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      origin[i] = Interval::of(active, rays.origin[i]);
      direction[i] = Interval::of(active, rays.direction[i]);
      pad = std::max(pad, origin[i].magnitude() * kRounding<T>);
      size = std::max(size, direction[i].magnitude());
    }
    for (std::size_t i = 0; i < 3; ++i) set(i, origin[i], direction[i], pad, size);
    one_origin_ = origin[0].empty() && origin[1].empty() && origin[2].empty();
    origin_ = {origin[0].lo, origin[1].lo, origin[2].lo};
  }

  // Returns whether all rays start at origin().
  bool one_origin() const { return one_origin_; }
  const Vec3<T>& origin() const { return origin_; }
  // Returns the octant of all directions: see RayBoxTester. REQUIRES: narrow().
  std::uint8_t octant() const {
    return static_cast<std::uint8_t>((axis_[0].near & 1) | (axis_[1].near & 1) << 1 |
                                     (axis_[2].near & 1) << 2);
  }
  // Returns whether the rays are coherent enough to be traversed together: all directions have one octant and
  // similar components.
  bool narrow() const { return narrow_; }
  // Returns the approximate width of the packet at the distance of the box, in metres.
  T width_at(const Bounds<T>& box) const {
    T distance = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      distance = std::max(
          {distance, box.lo[axis] - axis_[axis].near_origin, axis_[axis].near_origin - box.hi[axis]});
    return origins_ + directions_ * distance;
  }

  // Like RayBoxTester::enter(), with the smallest entry distance over the rays. Sets the bit of every box
  // that at least one of the rays enters. REQUIRES: narrow().
  [[gnu::always_inline]] unsigned enter(const BoxPlanes<T>& planes, T limit, N& near) const {
    near = N(T(0));
    N far = N(limit);
#pragma GCC unroll 3
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Axis& a = axis_[axis];
      const N in = planes[a.near] - N(a.near_origin), out = planes[a.near ^ 1] - N(a.far_origin);
      near = max_first(near, min_first(N(in * a.inverse_lo), N(in * a.inverse_hi)));
      far = min_first(far, max_first(N(out * a.inverse_lo), N(out * a.inverse_hi)));
    }
    return bits_of(near <= far * kFarther<T>);
  }

 private:
  struct Axis {
    std::size_t near;
    T inverse_lo, inverse_hi, near_origin, far_origin;
  };

  struct Interval {
    T lo, hi;
    static Interval of(const MaskOf<N>& active, const N& v) {
      const T first = v[0];
      if (all(v == N(first))) return {first, first};
      return {smallest(active, v), largest(active, v)};
    }
    T magnitude() const { return std::max(std::abs(lo), std::abs(hi)); }
    bool empty() const { return lo == hi; }
  };

  // `size` is the largest absolute direction component of all rays.
  void set(std::size_t axis, const Interval& origin, const Interval& direction, T pad, T size) {
    const T kLeast = T(1e-18) * size, kWidest = T(0.3) * size;
    const auto [lo, hi] = direction;
    const bool negative = hi < 0;
    narrow_ = narrow_ && (lo > kLeast || hi < -kLeast) && hi - lo < kWidest;
    directions_ = std::max(directions_, (hi - lo) / size);
    const T origin_lo = origin.lo - pad, origin_hi = origin.hi + pad;
    origins_ = std::max(origins_, origin.hi - origin.lo);
    axis_[axis] = {2 * axis + negative, 1 / hi, 1 / lo, negative ? origin_lo : origin_hi,
                   negative ? origin_hi : origin_lo};
  }

  std::array<Axis, 3> axis_;
  T origins_ = 0;     // largest extent of the origins along an axis, metres
  T directions_ = 0;  // largest extent of the directions along an axis, relative to their largest component
  bool narrow_ = true, one_origin_ = false;
  Vec3<T> origin_;
};

}  // namespace orrery
