#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/math/affine.h"
#include "core/meshes/gltf_json.h"

namespace orrery {

// Members of a node that replace those of the file.
struct NodePose {
  std::optional<Vec3d> translation, scale;
  std::optional<std::array<double, 4>> rotation;  // quaternion x, y, z, w of any length
  std::optional<std::vector<double>> weights;     // one per morph target
};

// Returns the transform from a node to its parent: the matrix of the node, or translation * rotation * scale.
// `pose` may be null. Throws InputError if a member of the node or of the pose is invalid, or if the pose
// moves a node with a matrix.
Affined transform_of(const GltfValue& node, const NodePose* pose);

}  // namespace orrery
