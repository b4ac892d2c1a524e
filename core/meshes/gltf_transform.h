#pragma once

#include "core/math/affine.h"
#include "core/meshes/gltf_json.h"

namespace orrery {

// Returns the transform from a node to its parent: the matrix of the node, or translation * rotation * scale.
// Throws InputError if a member of the node is invalid.
Affined transform_of(const GltfValue& node);

}  // namespace orrery
