#pragma once

#include "core/math/affine.h"
#include "core/meshes/gltf_json.h"
#include "core/meshes/model.h"

namespace orrery {

// Adds the camera and the light of a node to the model (glTF 2.0, section 3.10, and KHR_lights_punctual).
// Throws InputError if either is invalid.
void add_gltf_studio(const GltfValue& root, const GltfValue& node, const Affined& world_from_node,
                     MeshModel& model);

}  // namespace orrery
