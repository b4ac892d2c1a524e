#include "core/meshes/gltf_deformation.h"

#include <algorithm>
#include <cmath>

#include "core/base/task_scope.h"
#include "core/meshes/formats.h"

namespace orrery {
namespace {

constexpr std::size_t kMaxSets = 8;  // sets of four joints per vertex

Vec3d vector_at(const GltfNumbers& numbers, std::size_t i) {
  return {numbers.value(i, 0), numbers.value(i, 1), numbers.value(i, 2)};
}

// Adds `map` times `weight`.
void add_scaled(Affined& sum, const Affined& map, double weight) {
  sum.x = sum.x + map.x * weight;
  sum.y = sum.y + map.y * weight;
  sum.z = sum.z + map.z * weight;
  sum.origin = sum.origin + map.origin * weight;
}

void check_influences(const GltfNumbers& joints, const GltfNumbers& weights, std::size_t joint_count,
                      const GltfValue& attributes) {
  for (std::size_t i = 0; i < joints.count; ++i) {
    checkpoint(i);
    for (std::size_t k = 0; k < 4; ++k) {
      const double joint = joints.value(i, k), weight = weights.value(i, k);
      if (!(weight >= 0 && weight <= 1e6))
        attributes.fail("weights of joints must be from 0 to 1e6 (got " + text_of(weight) + " at vertex " +
                        std::to_string(i) + ")");
      if (!(joint >= 0 && joint < static_cast<double>(joint_count) && joint == std::floor(joint)))
        attributes.fail("joints must be integers >= 0 and < " + std::to_string(joint_count) + " (got " +
                        text_of(joint) + " at vertex " + std::to_string(i) + ")");
    }
  }
}

}  // namespace

Affined affine_of(const GltfNumbers& matrices, std::size_t i, const GltfValue& place) {
  std::array<double, 16> m;  // column-major
  for (std::size_t k = 0; k < m.size(); ++k) {
    m[k] = matrices.value(i, k);
    if (!std::isfinite(m[k]))
      place.fail("must be finite matrices (got " + text_of(m[k]) + " in matrix " + std::to_string(i) + ")");
  }
  return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
}

VertexPlacer::VertexPlacer(GltfFile& file, const GltfValue& primitive, std::size_t count,
                           const MeshPose& pose)
    : pose_(pose) {
  if (const auto targets = primitive.find("targets")) read_targets(file, *targets, count);
  if (pose_.joints) read_influences(file, primitive.at("attributes"), count);
}

// Leaves out the targets with weight 0.
void VertexPlacer::read_targets(GltfFile& file, const GltfValue& targets, std::size_t count) {
  for (std::size_t i = 0; i < std::min(targets.size(), pose_.weights.size()); ++i) {
    if (pose_.weights[i] == 0) continue;
    Target target{pose_.weights[i], {}, {}};
    if (const auto positions = targets.item(i).find("POSITION"))
      target.positions = file.attribute(*positions, "VEC3", count);
    if (const auto normals = targets.item(i).find("NORMAL"))
      target.normals = file.attribute(*normals, "VEC3", count);
    targets_.push_back(target);
  }
}

void VertexPlacer::read_influences(GltfFile& file, const GltfValue& attributes, std::size_t count) {
  for (std::size_t set = 0; set < kMaxSets; ++set) {
    const std::string number = std::to_string(set);
    const auto joints = attributes.find(("JOINTS_" + number).c_str());
    if (!joints) break;
    influences_.push_back({file.attribute(*joints, "VEC4", count),
                           file.attribute(attributes.at(("WEIGHTS_" + number).c_str()), "VEC4", count)});
    check_influences(influences_.back().joints, influences_.back().weights, pose_.joints->size(), attributes);
  }
}

Affined VertexPlacer::map_at(std::size_t vertex) const {
  if (influences_.empty()) return pose_.world_from_node;
  const JointTransforms& joints = *pose_.joints;
  double total = 0;
  for (const Influences& set : influences_)
    for (std::size_t k = 0; k < 4; ++k) total += set.weights.value(vertex, k);
  // A vertex without weights follows its first joint.
  if (!(total > 0)) return joints[static_cast<std::size_t>(influences_.front().joints.value(vertex, 0))];
  Affined map{{}, {}, {}, {}};
  for (const Influences& set : influences_)
    for (std::size_t k = 0; k < 4; ++k)
      if (const double weight = set.weights.value(vertex, k) / total; weight > 0)
        add_scaled(map, joints[static_cast<std::size_t>(set.joints.value(vertex, k))], weight);
  return map;
}

Vec3d VertexPlacer::position(std::size_t vertex, const Vec3d& stored) const {
  Vec3d moved = stored;
  for (const Target& target : targets_)
    if (target.positions) moved = moved + vector_at(*target.positions, vertex) * target.weight;
  return map_at(vertex).point(moved);
}

Vec3d VertexPlacer::normal(std::size_t vertex, const Vec3d& stored) const {
  Vec3d moved = stored;
  for (const Target& target : targets_)
    if (target.normals) moved = moved + vector_at(*target.normals, vertex) * target.weight;
  return transformed_normal(map_at(vertex), moved);
}

}  // namespace orrery
