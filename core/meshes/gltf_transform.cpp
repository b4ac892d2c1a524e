#include "core/meshes/gltf_transform.h"

#include <array>
#include <cmath>

namespace orrery {
namespace {

template <std::size_t count>
std::array<double, count> numbers_of(const GltfValue& value) {
  if (value.size() != count)
    value.fail("must be " + std::to_string(count) + " numbers (got " + std::to_string(value.size()) + ")");
  std::array<double, count> numbers;
  for (std::size_t i = 0; i < count; ++i) numbers[i] = value.item(i).number();
  return numbers;
}

Vec3d three_or(const GltfValue& node, const char* key, const Vec3d& fallback) {
  const auto value = node.find(key);
  if (!value) return fallback;
  const auto n = numbers_of<3>(*value);
  return {n[0], n[1], n[2]};
}

// Returns the rotation by a quaternion (x, y, z, w) of any length. Throws InputError if the quaternion is 0.
Affined rotation_of(std::array<double, 4> q, const GltfValue& place) {
  double largest = 0;
  for (const double part : q) largest = std::max(largest, std::abs(part));
  if (!(largest > 0)) place.fail("must be a non-zero quaternion (got 0)");
  double square = 0;
  for (double& part : q) square += (part / largest) * (part / largest);
  for (double& part : q) part = part / largest / std::sqrt(square);
  const auto [x, y, z, w] = q;
  return {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
          {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
          {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)},
          {}};
}

}  // namespace

Affined transform_of(const GltfValue& node, const NodePose* pose) {
  if (const auto matrix = node.find("matrix")) {
    if (pose && (pose->translation || pose->rotation || pose->scale))
      matrix->fail("must be translation, rotation and scale, because the node is animated");
    const auto m = numbers_of<16>(*matrix);  // column-major
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
      matrix->fail("last row must be 0, 0, 0 and 1 (got a projection)");
    return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
  }
  const auto quaternion = node.find("rotation");
  Affined transform;
  if (pose && pose->rotation)
    transform = rotation_of(*pose->rotation, node);
  else if (quaternion)
    transform = rotation_of(numbers_of<4>(*quaternion), *quaternion);
  const Vec3d scale = pose && pose->scale ? *pose->scale : three_or(node, "scale", {1, 1, 1});
  transform.x = transform.x * scale.x;
  transform.y = transform.y * scale.y;
  transform.z = transform.z * scale.z;
  transform.origin = pose && pose->translation ? *pose->translation : three_or(node, "translation", {});
  return transform;
}

}  // namespace orrery
