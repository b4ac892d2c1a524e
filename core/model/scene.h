#pragma once

#include <deque>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/math/affine.h"
#include "core/model/light.h"
#include "core/model/material.h"
#include "core/model/plan.h"
#include "core/model/shape.h"

namespace orrery {

// What the scene itself asks of a render; requests may say otherwise.
struct RenderSettings {
  int width = 600, height = 600;
  std::string technique = "whitted", accelerator = "auto";
  Precision precision = Precision::automatic;
  int max_depth = 5, samples = 1;
  double min_contribution = 0;
  std::uint64_t seed = 0;
  bool reorder = false;
  Prediction prediction = Prediction::none;
};

// What the plan wants to know about a scene, computed once.
struct SceneFacts {
  MaterialTraits materials;  // of those that some object has
  double magnitude = 0;      // largest absolute coordinate of bounded primitives, metres
  std::size_t left_out = 0;  // primitives without area
  double smallest_feature =
      std::numeric_limits<double>::infinity();  // smallest diagonal of a bounded primitive's box; infinite if
                                                // there is none
};

// Primitives of all sets together.
inline std::size_t count_primitives(const std::vector<std::unique_ptr<ShapeSet>>& sets) {
  std::size_t count = 0;
  for (const auto& shapes : sets) count += static_cast<std::size_t>(shapes->size());
  return count;
}

// Shapes that instances place.
struct Model {
  std::vector<std::unique_ptr<ShapeSet>> shapes;
  std::vector<std::int32_t> material_of;  // of each primitive
  Boundsd bounds;
};

struct Instance {
  std::size_t model;
  Affined world_from_model;
};

// A scene as read, in double precision; never changed afterwards, shared between threads. Primitives are
// numbered set by set in the order of `shapes`, materials likewise in the order of `materials`.
struct Scene {
  std::string id;  // SHA-256 of the canonical JSON
  std::string canonical;
  std::string title, description;
  Camera camera;
  RenderSettings render;
  Vec3d ambient, background;
  std::vector<std::unique_ptr<ShapeSet>> shapes;
  std::vector<std::unique_ptr<MaterialSet>> materials;
  std::vector<std::unique_ptr<Light>> lights;
  std::deque<Model> models;
  std::vector<Instance> instances;        // their primitives are numbered after those of `shapes`
  std::vector<std::int32_t> material_of;  // of each primitive
  int object_count = 0;
  SceneFacts facts;

  int primitive_count() const { return static_cast<int>(material_of.size()); }
};

}  // namespace orrery
