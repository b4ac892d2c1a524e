#include "server/import/placement.h"

#include <array>
#include <cmath>
#include <numbers>

namespace orrery {
namespace {

struct Rotation {
  Vec3d axis;
  double degrees;
};

// Axis and angle of a rotation matrix with the columns x, y, z, by the quaternion of Shepperd (1978): the
// largest component is computed first, so nothing cancels.
Rotation rotation_of(const Vec3d& x, const Vec3d& y, const Vec3d& z) {
  const double trace = x.x + y.y + z.z;
  std::array<double, 4> q{};  // w, x, y, z times a common factor
  if (trace >= x.x && trace >= y.y && trace >= z.z)
    q = {1 + trace, y.z - z.y, z.x - x.z, x.y - y.x};
  else if (x.x >= y.y && x.x >= z.z)
    q = {y.z - z.y, 1 + x.x - y.y - z.z, x.y + y.x, x.z + z.x};
  else if (y.y >= z.z)
    q = {z.x - x.z, x.y + y.x, 1 + y.y - x.x - z.z, y.z + z.y};
  else
    q = {x.y - y.x, x.z + z.x, y.z + z.y, 1 + z.z - x.x - y.y};
  const Vec3d v{q[1], q[2], q[3]};
  const double sine = length(v);
  if (!(sine > 1e-15 * std::abs(q[0]))) return {{0, 1, 0}, 0};
  return {v / sine, 2 * std::atan2(sine, q[0]) * 180 / std::numbers::pi};
}

InstanceParts parts_of(const Affined& map, const Vec3d& x, const Vec3d& y, const Vec3d& z) {
  const bool mirrors = dot(x, cross(y, z)) < 0;
  const auto [axis, degrees] = rotation_of(x, y, mirrors ? -z : z);
  return {{length(map.x), length(map.y), (mirrors ? -1 : 1) * length(map.z)}, axis, degrees, map.origin};
}

}  // namespace

Affined looking_at(const Vec3d& eye, const Vec3d& target, const Vec3d& up) {
  const Vec3d forward = safe_normalize(target - eye);
  const Vec3d side = safe_normalize(cross(safe_normalize(up), forward));
  return {side, cross(forward, side), forward, eye};
}

std::optional<InstanceParts> instance_parts(const Affined& map) {
  const Vec3d x = safe_normalize(map.x), y = safe_normalize(map.y), z = safe_normalize(map.z);
  const auto at_right_angles = [](const Vec3d& a, const Vec3d& b) { return std::abs(dot(a, b)) <= kMaxSkew; };
  if (!at_right_angles(x, y) || !at_right_angles(y, z) || !at_right_angles(z, x)) return std::nullopt;
  return parts_of(map, x, y, z);
}

InstanceParts nearest_instance_parts(const Affined& map) {
  const Vec3d x = safe_normalize(map.x);
  const Vec3d y = safe_normalize(map.y - x * dot(x, map.y));
  const Vec3d up = cross(x, y);
  return parts_of(map, x, y, dot(up, map.z) < 0 ? -up : up);
}

std::optional<double> uniform_scale(const Affined& map) {
  if (!instance_parts(map)) return std::nullopt;
  const double scale = length(map.x);
  const auto same = [&](const Vec3d& axis) { return std::abs(length(axis) - scale) <= kMaxSkew * scale; };
  if (!same(map.y) || !same(map.z)) return std::nullopt;
  return scale;
}

bool is_identity(const Affined& map) {
  return map.x == Vec3d(1, 0, 0) && map.y == Vec3d(0, 1, 0) && map.z == Vec3d(0, 0, 1) &&
         map.origin == Vec3d(0, 0, 0);
}

}  // namespace orrery
