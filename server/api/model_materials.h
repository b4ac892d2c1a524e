#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/meshes/model.h"

namespace orrery {

// File of a model as a scene refers to it.
struct ModelReference {
  const char* key;    // "file" or "asset"
  std::string name;   // value of the key
  std::string title;  // title of the scene
};

// Adds one object per material of the model to a scene, with the materials and textures that they use. A
// model without materials receives the material `plain`. Meshes without normals are smooth across edges of
// less than `crease_degrees`. Images that is_shown() rejects are left out. Throws InputError (pointer "") if
// the materials use more than kMaxTextures textures.
void add_model(nlohmann::ordered_json& scene, const MeshModel& model, const ModelReference& reference,
               const nlohmann::ordered_json& plain, double crease_degrees);

}  // namespace orrery
