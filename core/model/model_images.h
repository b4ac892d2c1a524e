#pragma once

#include <string>
#include <vector>

#include "core/meshes/model.h"

namespace orrery {

// Returns whether the bytes have the signature of an image that textures can have. It may be damaged.
bool is_shown(const ModelImage& image);

// Returns the notes of the mesh and those about images that are not shown.
std::vector<std::string> notes_of(const MeshModel& model);

}  // namespace orrery
