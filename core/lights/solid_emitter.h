#pragma once

#include "core/lights/emitter.h"

namespace orrery {

// Cylinder wall visible from an outside point. Samples are uniform across the visible width of the wall.
// Along its length, they are uniform in the sine of the elevation from the point.
template <class N>
class VisibleCylinderWall {
  using T = ScalarOf<N>;

 public:
  // `from` is the vector from the cylinder's centre to the shading point. `axis` is a unit vector.
  VisibleCylinderWall(const Vec3<N>& from, const Vec3<N>& axis, const N& radius, const N& half_length)
      : axis_(axis), radius_(radius), along_(dot(from, axis)) {
    using std::sqrt;
    const N zero(T(0)), one(T(1));
    const Vec3<N> across = from - axis * along_;
    const N distance = length(across);
    outside_ = distance > radius;
    reach_ = max_first(radius, distance);
    toward_ = select(distance > zero, across * (one / distance), tangents_of(axis).first);
    min_ = -half_length - along_;
    max_ = half_length - along_;
    low_ = sine(min_);
    range_ = sine(max_) - low_;
    const N share = radius / reach_;
    half_width_ = sqrt(max_first(zero, N((one - share) * (one + share))));
  }

  // Returns whether the shading point is outside the infinitely extended cylinder.
  const MaskOf<N>& outside() const { return outside_; }
  // Returns the approximate solid angle in steradians. The error vanishes as the radius goes to 0.
  N angle() const { return T(2) * radius_ / reach_ * range_; }

  struct Point {
    Vec3<N> from_centre, normal;
  };
  // Samples a point for uniform u (lengthwise) and v (across) in [0, 1).
  Point draw(const N& u, const N& v) const {
    using std::sqrt;
    const N one(T(1)), s = low_ + u * range_;
    const N rest = sqrt(max_first(N(std::numeric_limits<T>::min()), N((one - s) * (one + s))));
    const N z = max_first(min_, min_first(max_, N(reach_ * s / rest)));
    const N y = half_width_ * (v + v - one);
    const N facing = sqrt(max_first(N(T(0)), N(one - y * y)));
    const Vec3<N> normal = toward_ * facing + cross(axis_, toward_) * y;
    return {axis_ * (along_ + z) + normal * radius_, normal};
  }

  // Returns the density of draw() per square metre of the wall.
  N density(const Point& point) const {
    using std::sqrt;
    const N zero(T(0)), z = dot(point.from_centre, axis_) - along_, squares = z * z + reach_ * reach_;
    const N lengthwise = reach_ * reach_ / (squares * sqrt(squares) * range_);
    const N across = dot(point.normal, toward_) / (T(2) * half_width_);
    return select(outside_ && across > zero, N(lengthwise * across / radius_), zero);
  }

 private:
  N sine(const N& z) const {
    using std::sqrt;
    return z / sqrt(z * z + reach_ * reach_);
  }

  Vec3<N> axis_, toward_;
  N radius_, along_, reach_, min_, max_, low_, range_, half_width_;
  MaskOf<N> outside_;
};

// Emitting box or cylinder, sampled from an outside point: draw() selects a visible face or the wall by
// approximate solid angle. If the shading point is inside the solid, all densities are 0. The solid then
// fills the whole view, so BSDF sampling always finds it, and rounding may move points of its inner surface
// outside. Results are undefined in lanes with emitters of other kinds.
template <class N>
class SolidEmitter {
  using T = ScalarOf<N>;

 public:
  using LightSample = typename Emitter<N>::LightSample;

  SolidEmitter(const Emitter<N>& solid, const Vec3<N>& from)
      : solid_(solid),
        from_(from),
        box_(solid.is(Patch::Kind::box)),
        wall_(from - solid.at, solid.normal, solid.length_a, solid.length_c) {
    for (int k = 0; k < kParts; ++k) {
      weight_[static_cast<std::size_t>(k)] = weight(k);
      sum_ = sum_ + weight_[static_cast<std::size_t>(k)];
    }
  }

  LightSample draw(const N& u, const N& v) const {
    const N target = u * sum_, zero(T(0));
    N end = zero, begin = zero, share = zero;
    Emitter<N> part = solid_;
    for (int k = 0; k < kParts; ++k) {
      const N& weight = weight_[static_cast<std::size_t>(k)];
      const auto chosen = weight > zero && target >= end;
      part = select_part(chosen, this->part(k), part);
      begin = select(chosen, end, begin);
      share = select(chosen, weight, share);
      end = end + weight;
    }
    constexpr T kBelowOne = 1 - std::numeric_limits<T>::epsilon() / 2;
    const N within = min_first(N(kBelowOne), N((target - begin) / share));
    const LightSample flat = part.draw(from_, within, v), round = draw_wall(within, v);
    const auto on_wall = part.is(Patch::Kind::cylinder);
    return {select(on_wall, round.point, flat.point), select(on_wall, round.normal, flat.normal),
            select(share > zero, N(select(on_wall, round.pdf, flat.pdf) * share / sum_), zero)};
  }

  // Returns the density of draw() per solid angle, for the direction of a unit ray that hits the solid at t.
  N pdf(const Ray<N>& ray, const N& t) const {
    const Vec3<N> hit = ray.at(t);
    N nearest(std::numeric_limits<T>::infinity()), share(T(0));
    Emitter<N> part = solid_;
    for (int k = 0; k < kParts; ++k) {
      const Emitter<N> one = this->part(k);
      const N off = distance_to(one, hit);
      const auto nearer = off < nearest;
      nearest = select(nearer, off, nearest);
      share = select(nearer, weight_[static_cast<std::size_t>(k)], share);
      part = select_part(nearer, one, part);
    }
    const Vec3<N> from_centre = hit - solid_.at;
    const typename VisibleCylinderWall<N>::Point on_wall{from_centre, normalize(across(from_centre))};
    const N round = per_angle(wall_.density(on_wall), t * t, dot(on_wall.normal, ray.direction));
    const N density = select(part.is(Patch::Kind::cylinder), round, part.pdf(ray, t));
    return select(share > N(T(0)), N(density * share / sum_), N(T(0)));
  }

 private:
  static constexpr int kParts = 6;  // box: six faces; cylinder: two ends and the wall, of Kind::cylinder

  // Returns part k, with the normal outward.
  Emitter<N> part(int k) const {
    const std::array<Vec3<N>, 3> axes{solid_.normal, solid_.a, solid_.b};
    const std::array<N, 3> half{solid_.length_c, solid_.length_a, solid_.length_b};
    const auto axis = static_cast<std::size_t>(k / 2), i = (axis + 1) % 3, j = (axis + 2) % 3;
    const N sign(T(k % 2 == 0 ? -1 : 1));
    Emitter<N> face = solid_;
    face.normal = axes[axis] * sign;
    face.at = solid_.at + face.normal * half[axis];
    face.a = select(box_, axes[i], axes[i] * half[i]);
    face.b = select(box_, axes[j], axes[j] * half[j]);
    face.length_a = half[i] + half[i];
    face.length_b = half[j] + half[j];
    face.at = select(box_, face.at - axes[i] * half[i] - axes[j] * half[j], face.at);
    face.area = half[i] * half[j] * select(box_, N(T(4)), N(std::numbers::pi_v<T>));
    face.kind = kind_of(box_, Patch::Kind::rectangle, Patch::Kind::disk);
    return k < 2 ? face : select_part(box_, face, solid_);
  }

  N weight(int k) const {
    using std::sqrt;
    const N zero(T(0)), half(T(0.5));
    const Emitter<N> one = part(k);
    const N above = max_first(zero, dot(from_ - one.at, one.normal));
    const Vec3<N> to_centre =
        from_ - one.at -
        select(box_, one.a * (one.length_a * half) + one.b * (one.length_b * half), Vec3<N>(zero));
    const N distance2 = max_first(N(std::numeric_limits<T>::min()), dot(to_centre, to_centre));
    const N small = one.area * (above / (distance2 * sqrt(distance2)));
    const N angle = box_angle(one);
    const N flat = select(above > zero, select(angle > zero, angle, small), zero);
    if (k < 2) return flat;
    const N wall = k == 2 ? select(wall_.outside(), wall_.angle(), zero) : zero;
    return select(box_, flat, wall);
  }
  N box_angle(const Emitter<N>& face) const {
    return any(box_) ? select(box_, face.angle(from_), N(T(0))) : N(T(0));
  }

  LightSample draw_wall(const N& u, const N& v) const {
    const auto point = wall_.draw(u, v);
    const Vec3<N> at = solid_.at + point.from_centre, line = at - from_;
    const N distance2 = dot(line, line);
    using std::sqrt;
    return {at, point.normal,
            per_angle(wall_.density(point), distance2, dot(point.normal, line) / sqrt(distance2))};
  }

  static N per_angle(const N& per_area, const N& distance2, const N& cosine) {
    using std::abs;
    const N c = abs(cosine);
    return select(c > N(T(0)), N(per_area * distance2 / c), N(T(0)));
  }

  Vec3<N> across(const Vec3<N>& from_centre) const {
    return from_centre - solid_.normal * dot(from_centre, solid_.normal);
  }
  N distance_to(const Emitter<N>& part, const Vec3<N>& hit) const {
    using std::abs;
    const N round = abs(length(across(hit - solid_.at)) - solid_.length_a);
    return select(part.is(Patch::Kind::cylinder), round, abs(dot(hit - part.at, part.normal)));
  }

  static N kind_of(const MaskOf<N>& mask, Patch::Kind x, Patch::Kind y) {
    return select(mask, N(static_cast<T>(x)), N(static_cast<T>(y)));
  }
  static Emitter<N> select_part(const MaskOf<N>& mask, const Emitter<N>& x, const Emitter<N>& y) {
    Emitter<N> one = x;
    one.at = select(mask, x.at, y.at);
    one.a = select(mask, x.a, y.a);
    one.b = select(mask, x.b, y.b);
    one.normal = select(mask, x.normal, y.normal);
    one.length_a = select(mask, x.length_a, y.length_a);
    one.length_b = select(mask, x.length_b, y.length_b);
    one.kind = select(mask, x.kind, y.kind);
    one.area = select(mask, x.area, y.area);
    return one;
  }

  const Emitter<N>& solid_;
  const Vec3<N> from_;
  const MaskOf<N> box_;
  const VisibleCylinderWall<N> wall_;
  std::array<N, kParts> weight_;
  N sum_ = N(T(0));
};

}  // namespace orrery
