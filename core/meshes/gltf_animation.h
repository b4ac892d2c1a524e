#pragma once

#include <map>

#include "core/meshes/gltf_file.h"
#include "core/meshes/gltf_transform.h"
#include "core/meshes/model.h"

namespace orrery {

// Members of nodes that an animation changes, by node.
using GltfPose = std::map<std::size_t, NodePose>;

// Returns the values of an animation at a time (glTF 2.0, 3.11 and appendix C). Before the first keyframe of
// a sampler, its value is that of the first keyframe, and after the last one that of the last. Throws
// InputError if the file lacks the animation, or if the animation is invalid.
GltfPose read_pose(GltfFile& file, const ModelPose& pose);

// Returns the animations of the file, which are not checked.
std::vector<ModelAnimation> list_animations(const GltfFile& file);

}  // namespace orrery
