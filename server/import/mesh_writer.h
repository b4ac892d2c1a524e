#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/meshes/mesh_file.h"

namespace orrery {

// Adds the keys of an inline mesh to an object of a scene.
void add_mesh_keys(nlohmann::ordered_json& object, const TriangleMesh& mesh);

// Returns a binary PLY file with positions, normals and texture coordinates in double precision.
std::string ply_of(const TriangleMesh& mesh);

}  // namespace orrery
