#pragma once

#include "core/math/affine.h"
#include "core/math/elementary.h"
#include "core/model/texture.h"

namespace orrery {

// Texture coordinates of a point, and their derivatives along two directions, per metre.
template <class N>
struct TextureCoordinates {
  Vec3<N> at, along_first, along_second;
};

// TextureMapping in lanes or scalars.
template <class N>
struct MappingOf {
  TextureMapping::Kind kind;
  Vec3<N> origin, x, y, z;
  N u_of_u, u_of_v, v_of_u, v_of_v;  // matrix of `repeat` and the turn
  N shift_u, shift_v;

  explicit MappingOf(const TextureMapping& m)
      : kind(m.kind),
        origin(Vec3<ScalarOf<N>>(m.origin)),
        x(Vec3<ScalarOf<N>>(m.x)),
        y(Vec3<ScalarOf<N>>(m.y)),
        z(Vec3<ScalarOf<N>>(m.z)),
        u_of_u(static_cast<ScalarOf<N>>(m.cosine * m.repeat[0])),
        u_of_v(static_cast<ScalarOf<N>>(-m.sine * m.repeat[1])),
        v_of_u(static_cast<ScalarOf<N>>(m.sine * m.repeat[0])),
        v_of_v(static_cast<ScalarOf<N>>(m.cosine * m.repeat[1])),
        shift_u(static_cast<ScalarOf<N>>(m.shift[0])),
        shift_v(static_cast<ScalarOf<N>>(m.shift[1])) {}

  // Returns the coordinates of `point` and the derivatives along `first` and `second`, for every kind except
  // uv. On the axis of a spherical or cylindrical mapping, u is 0 and its derivatives are 0.
  TextureCoordinates<N> coordinates(const Vec3<N>& point, const Vec3<N>& first, const Vec3<N>& second) const {
    const N zero(ScalarOf<N>(0));
    const Vec3<N> q = rows(point - origin), a = rows(first), b = rows(second);
    switch (kind) {
      case TextureMapping::Kind::solid: return {q, a, b};
      case TextureMapping::Kind::planar: return {{q.x, q.y, zero}, {a.x, a.y, zero}, {b.x, b.y, zero}};
      case TextureMapping::Kind::cylindrical:
        return repeated({{turns(q), q.y, zero}, {turning(q, a), a.y, zero}, {turning(q, b), b.y, zero}});
      case TextureMapping::Kind::spherical:
        return repeated({{turns(q), latitude(q), zero},
                         {turning(q, a), rising(q, a), zero},
                         {turning(q, b), rising(q, b), zero}});
      case TextureMapping::Kind::uv: break;
    }
    return {q, a, b};
  }

  // Applies `repeat`, the turn and `shift`.
  TextureCoordinates<N> repeated(const TextureCoordinates<N>& c) const {
    const auto scaled = [this](const Vec3<N>& v) {
      return Vec3<N>(v.x * u_of_u + v.y * u_of_v, v.x * v_of_u + v.y * v_of_v, v.z);
    };
    const Vec3<N> at = scaled(c.at);
    return {{at.x + shift_u, at.y + shift_v, at.z}, scaled(c.along_first), scaled(c.along_second)};
  }

 private:
  Vec3<N> rows(const Vec3<N>& v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }

  // The conventions of the sphere: see core/shapes/sphere.h.
  static N turns(const Vec3<N>& q) { return positive_turns(q.x, N(-q.z)); }
  static N latitude(const Vec3<N>& q) {
    using T = ScalarOf<N>;
    using std::sqrt;
    return T(0.5) + T(2) * direction_turns(N(sqrt(q.x * q.x + q.z * q.z)), q.y);
  }
  // Derivatives of turns() and latitude() along v.
  static N turning(const Vec3<N>& q, const Vec3<N>& v) {
    using T = ScalarOf<N>;
    const N across2 = q.x * q.x + q.z * q.z, zero(T(0));
    const auto off_axis = across2 > zero;
    constexpr T kTurns = T(0.15915494309189533577L);  // 1 / (2 pi)
    return select(off_axis, N((q.z * v.x - q.x * v.z) * kTurns / select(off_axis, across2, N(T(1)))), zero);
  }
  static N rising(const Vec3<N>& q, const Vec3<N>& v) {
    using T = ScalarOf<N>;
    using std::sqrt;
    const N across2 = q.x * q.x + q.z * q.z, size2 = across2 + q.y * q.y, zero(T(0));
    const auto off_axis = across2 > zero;
    const N across = sqrt(select(off_axis, across2, N(T(1))));
    constexpr T kHalfTurns = T(0.31830988618379067154L);  // 1 / pi
    const N change = v.y * across - q.y * (q.x * v.x + q.z * v.z) / across;
    return select(off_axis, N(change * kHalfTurns / select(off_axis, size2, N(T(1)))), zero);
  }
};

// Returns the sides of the axis-aligned box around the image, in texture coordinates, of a disc of diameter
// `footprint` across the ray that is projected along the ray onto the tangent plane, to first order. `first`
// and `second` are orthonormal in the plane, with the normal `normal`. The cosine between ray and normal
// divides the footprint. A vector e across the ray reaches the plane at e - d (n.e) / (n.d). The side of the
// box is the length of the vector of the derivatives along two perpendicular such vectors.
template <class N>
Vec3<N> box_of_footprint(const TextureCoordinates<N>& c, const Vec3<N>& first, const Vec3<N>& second,
                         const Vec3<N>& normal, const Vec3<N>& direction, const N& footprint) {
  using T = ScalarOf<N>;
  using std::sqrt;
  const N most(static_cast<T>(kMaxTextureWidth)), over = N(T(1)) / dot(normal, direction);
  // With the gradient g in the plane, the sum over both vectors of (g.e - (g.d)(n.e) / (n.d))^2 is
  // |g|^2 + ((g.d) / (n.d))^2, because g is perpendicular to n.
  const N first_slope = dot(first, direction) * over, second_slope = dot(second, direction) * over;
  const auto side = [&](const N& a, const N& b) {
    const N slope = a * first_slope + b * second_slope;
    return min_first(most, N(footprint * sqrt(a * a + b * b + slope * slope)));  // NaN becomes `most`
  };
  return {side(c.along_first.x, c.along_second.x), side(c.along_first.y, c.along_second.y),
          side(c.along_first.z, c.along_second.z)};
}

}  // namespace orrery
