#pragma once

#include <numbers>

#include "core/math/elementary.h"
#include "core/math/hemisphere.h"
#include "core/model/shape.h"

namespace orrery {

// Spherical rectangle: solid angle of a rectangle, and points of the rectangle that are uniform in solid
// angle (Ureña, Fajardo, King, "An Area-Preserving Parametrization for Spherical Rectangles", EGSR 2013). The
// solid angle is computed as a sum of arc sines, because the paper subtracts a constant from a sum of arc
// cosines, which cancels digits.
template <class N>
class SphericalRectangle {
  using T = ScalarOf<N>;

 public:
  // `from` is the vector from the shading point to the corner. `a` and `b` are the unit vectors of the sides,
  // `normal` is the unit normal.
  SphericalRectangle(const Vec3<N>& from, const Vec3<N>& a, const N& length_a, const Vec3<N>& b,
                     const N& length_b, const Vec3<N>& normal) {
    using std::abs;
    z0_ = -abs(dot(from, normal));
    x0_ = dot(from, a);
    y0_ = dot(from, b);
    x1_ = x0_ + length_a;
    y1_ = y0_ + length_b;
    const auto reach = [this](const N& side) { return reciprocal_length(side, z0_); };
    const N sx0 = x0_ * reach(x0_), sx1 = x1_ * reach(x1_), sy0 = y0_ * reach(y0_), sy1 = y1_ * reach(y1_);
    b0_ = -sy0;
    b1_ = sy1;
    const N c2 = arc_sine(N(-sy1 * sx0)), c3 = arc_sine(N(sx0 * sy0));
    k_ = N(std::numbers::pi_v<T>) - c2 - c3;
    angle_ = arc_sine(N(-sy0 * sx1)) + arc_sine(N(sx1 * sy1)) + c2 + c3;
  }

  const N& angle() const { return angle_; }  // steradians

  // Point of the rectangle: distances from the corner along both sides, in metres.
  struct Lengths {
    N along_a, along_b;
  };
  // Returns a point for u and v in [0, 1). If u and v are uniform, the point is uniform in solid angle.
  Lengths draw(const N& u, const N& v) const {
    using std::sqrt;
    const N zero(T(0)), one(T(1));
    const auto [sine, cosine] = sine_cosine_turns(N((u * angle_ + k_) * T(0.5 / std::numbers::pi)));
    const N f = (cosine * b0_ - b1_) / sine;
    const N root = reciprocal_length(f, b0_);
    const N cu = min_first(one, max_first(N(-one), select(f < zero, N(-root), root)));
    const N x =
        min_first(x1_, max_first(x0_, N(-(cu * z0_) / sqrt(max_first(N(T(1e-12)), N(one - cu * cu))))));
    const N d2 = x * x + z0_ * z0_;
    const N h0 = y0_ * (one / sqrt(d2 + y0_ * y0_)), h1 = y1_ * (one / sqrt(d2 + y1_ * y1_));
    const N h = h0 + v * (h1 - h0), rest = one - h * h;
    const N y = select(rest > N(T(1e-6)), N(h * sqrt(d2 / max_first(N(T(1e-6)), rest))), y1_);
    return {x - x0_, min_first(y1_, max_first(y0_, y)) - y0_};
  }

 private:
  static N reciprocal_length(const N& x, const N& y) {
    using std::sqrt;
    return T(1) / sqrt(max_first(N(x * x + y * y), N(std::numeric_limits<T>::min())));
  }
  static N arc_sine(const N& x) {
    using std::sqrt;
    const N rest = sqrt(max_first(N(T(0)), N((T(1) - x) * (T(1) + x))));
    return direction_turns(rest, x) * T(2 * std::numbers::pi);
  }

  N x0_, x1_, y0_, y1_, z0_, b0_, b1_, k_, angle_;
};

// Two-sided emitting surface, sampled from a shading point. Rectangles and spheres are sampled by solid
// angle. Triangles, disks, small rectangles, and spheres seen from inside are sampled by area. SolidEmitter
// samples boxes and cylinders.
template <class N>
struct Emitter {
  Vec3<N> at, a, b;  // see Patch; a and b are unit vectors for a rectangle, box or cylinder
  Vec3<N> normal;    // unit; for a box or cylinder, the direction of Patch::c
  Vec3<N> radiance;
  N length_a, length_b, length_c;  // lengths of the vectors in Patch
  N kind, area, magnitude;         // Patch::Kind, square metres, largest absolute coordinate

  struct LightSample {
    Vec3<N> point, normal;  // on the emitter; the unit normal may face either side
    N pdf;                  // per solid angle; 0 if no light arrives
  };
  // Samples a point for uniform u and v in [0, 1). `from` is the shading point. Undefined for boxes and
  // cylinders.
  LightSample draw(const Vec3<N>& from, const N& u, const N& v) const {
    const auto round = is(Patch::Kind::sphere);
    const LightSample flat = draw_flat(from, u, v);
    if (!any(round)) return flat;
    const LightSample ball = draw_sphere(from, u, v);
    return {select(round, ball.point, flat.point), select(round, ball.normal, flat.normal),
            select(round, ball.pdf, flat.pdf)};
  }

  MaskOf<N> is(Patch::Kind k) const { return kind == N(static_cast<ScalarOf<N>>(k)); }

  MaskOf<N> is_solid() const { return is(Patch::Kind::box) || is(Patch::Kind::cylinder); }

  // Returns the solid angle of a rectangle in steradians, or 0 if the angle is so small that draw() samples
  // by area.
  N angle(const Vec3<N>& from) const { return large_angle(spherical(from)); }

  // Returns the density of draw() per solid angle, for the direction of a unit ray that hits the emitter at
  // t.
  N pdf(const Ray<N>& ray, const N& t) const {
    using std::abs;
    const auto round = is(Patch::Kind::sphere);
    const Vec3<N> radial = (ray.at(t) - at) / length_a;
    const Vec3<N> facing = select(round, radial, normal);
    const N by_area = density(t * t, abs(dot(facing, ray.direction)));
    N by_angle(T(0));
    if (any(round)) by_angle = select(round, cone(ray.origin).density, by_angle);
    const auto square = is(Patch::Kind::rectangle);
    if (any(square)) by_angle = select(square, rectangle_density(spherical(ray.origin)), by_angle);
    return select(by_angle > N(T(0)), by_angle, by_area);
  }

 private:
  using T = ScalarOf<N>;
  static constexpr T kMinAngle = T(0.02);  // steradians; smaller rectangles are sampled by area

  N density(const N& distance2, const N& cosine) const {
    return select(cosine > N(T(0)), N(distance2 / (cosine * area)), N(T(0)));
  }

  SphericalRectangle<N> spherical(const Vec3<N>& from) const {
    return {at - from, a, length_a, b, length_b, normal};
  }
  static N large_angle(const SphericalRectangle<N>& seen) {
    return select(seen.angle() > N(kMinAngle), seen.angle(), N(T(0)));
  }
  static N rectangle_density(const SphericalRectangle<N>& seen) {
    const N angle = large_angle(seen);
    return select(angle > N(T(0)), N(T(1) / angle), N(T(0)));
  }

  LightSample draw_flat(const Vec3<N>& from, const N& u, const N& v) const {
    using std::abs;
    using std::sqrt;
    const N root = sqrt(u);
    N s = u * length_a, t = v * length_b;
    const auto three = is(Patch::Kind::triangle), circular = is(Patch::Kind::disk);
    if (any(three)) {
      s = select(three, N(root * (T(1) - v)), s);
      t = select(three, N(root * v), t);
    }
    if (any(circular)) {
      const auto [sine, cosine] = sine_cosine_turns(v);
      s = select(circular, N(root * cosine), s);
      t = select(circular, N(root * sine), t);
    }
    N by_angle(T(0));
    const auto square = is(Patch::Kind::rectangle);
    if (any(square)) {
      const SphericalRectangle<N> seen = spherical(from);
      by_angle = select(square, rectangle_density(seen), by_angle);
      const auto large = by_angle > N(T(0));
      if (any(large)) {
        const auto [along_a, along_b] = seen.draw(u, v);
        s = select(large, along_a, s);
        t = select(large, along_b, t);
      }
    }
    const Vec3<N> point = at + a * s + b * t, toward = point - from;
    const N distance2 = dot(toward, toward);
    const N cosine = abs(dot(toward, normal)) / sqrt(distance2);
    const N by_area = density(distance2, cosine);
    return {point, normal, select(by_angle > N(T(0)), select(cosine > N(T(0)), by_angle, N(T(0))), by_area)};
  }

  // Cone of directions in which an outside point sees a sphere.
  struct Cone {
    N height;   // 1 - cosine of the half angle, without cancellation; 0 if the point is inside
    N density;  // per solid angle; 0 if the point is inside
  };
  Cone cone(const Vec3<N>& from) const {
    using std::sqrt;
    const Vec3<N> toward = at - from;
    const N distance2 = dot(toward, toward), zero(T(0)), one(T(1));
    const N sine2 = length_a * length_a / distance2;
    // Points on the sphere, up to rounding, count as inside.
    const N rounding = T(128) * std::numeric_limits<T>::epsilon() * magnitude * length_a;
    const auto outside = distance2 - length_a * length_a > rounding;
    const N height = sine2 / (one + sqrt(max_first(zero, N(one - sine2))));
    return {select(outside, height, zero), select(outside, N(T(0.5 / std::numbers::pi) / height), zero)};
  }

  LightSample draw_sphere(const Vec3<N>& from, const N& u, const N& v) const {
    using std::abs;
    using std::sqrt;
    const N zero(T(0)), one(T(1));
    const auto [height, by_angle] = cone(from);
    const auto outside = height > zero;
    const auto [sine_v, cosine_v] = sine_cosine_turns(v);
    // Samples a direction from the centre: uniformly if `from` is inside, otherwise in the visible cap.
    const Vec3<N> toward = at - from;
    const N distance2 = dot(toward, toward), distance = sqrt(distance2);
    const N h = u * height, sine2 = h * (T(2) - h), cosine = one - h;
    const N root = sqrt(max_first(zero, N(length_a * length_a - distance2 * sine2)));
    const N along = distance * cosine - root;  // distance to the hit
    const N axial = (distance - along * cosine) / length_a, across = along * sqrt(sine2) / length_a;
    const N z = select(outside, axial, N(one - T(2) * u));
    const N r = select(outside, across, sqrt(max_first(zero, N(one - z * z))));
    const Vec3<N> axis = select(outside, toward * (T(-1) / distance), Vec3<N>(zero, zero, one));
    const Tangents<N> basis = tangents_of(axis);
    const Vec3<N> out = basis.first * (r * cosine_v) + basis.second * (r * sine_v) + axis * z;
    const Vec3<N> point = at + out * length_a, line = point - from;
    const N line2 = dot(line, line);
    const N by_area = density(line2, abs(dot(line, out)) / sqrt(line2));
    return {point, out, select(outside, by_angle, by_area)};
  }
};

}  // namespace orrery
