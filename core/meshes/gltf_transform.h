#pragma once

#include "core/math/affine.h"
#include "core/meshes/gltf_json.h"

namespace orrery {

// Returns the transform from a node to its parent: its matrix, or translation * rotation * scale. Throws
// InputError if one of these is invalid.
Affined transform_of(const GltfValue& node);

}  // namespace orrery
