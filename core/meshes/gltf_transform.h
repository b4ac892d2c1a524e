#pragma once

#include "core/math/affine.h"
#include "core/meshes/gltf_json.h"

namespace orrery {

// The transform of a node to its parent: its matrix, or translation * rotation * scale. Throws InputError.
Affined transform_of(const GltfValue& node);

}  // namespace orrery
