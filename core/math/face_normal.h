#pragma once

#include <algorithm>

#include "core/math/vec3.h"

namespace orrery {

// A triangle is long and thin where its longest side is more than so many times its height, about.
inline constexpr double kThinAspect = 64;

// Unit normal of a triangle by the right-hand rule, or 0 if it has no area. The product of two long sides of
// a long thin triangle loses as many digits as its aspect ratio has; that of the two shorter sides loses
// none.
inline Vec3d face_normal(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d ab = b - a, bc = c - b, ca = a - c;
  const Vec3d product = cross(ab, c - a);
  const auto size = [](const Vec3d& side) { return max_component(abs(side)); };
  const double first = size(ab), second = size(bc), third = size(ca),
               longest = std::max({first, second, third});
  if (size(product) * kThinAspect >= longest * longest) return safe_normalize(product);
  return safe_normalize(first == longest ? cross(bc, ca) : second == longest ? cross(ca, ab) : cross(ab, bc));
}

}  // namespace orrery
