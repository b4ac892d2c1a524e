#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "server/import/scene_writer.h"

namespace orrery {

// Value of a material: `factor`, multiplied by a texture of the scene if `texture` has a name, or 1 minus
// that.
struct ImportValue {
  Vec3d factor{1};
  std::string texture = {};
  bool inverted = false;

  bool is_constant() const { return texture.empty(); }
  // Returns the constant, or a guess at the mean of the texture.
  Vec3d mean() const {
    const Vec3d value = is_constant() ? factor : factor * 0.5;
    return inverted ? Vec3d(1) - value : value;
  }
};

inline ImportValue grey(double value) { return {Vec3d(value)}; }

// Return the value as JSON. Colours are clamped to 0 to `most`, with a note.
SceneJson color_json(SceneWriter& scene, const ImportValue& value, double most = 1);
SceneJson number_json(SceneWriter& scene, const ImportValue& value, double least, double most);

// Roughness parameter of scenes, from the alpha of a microfacet distribution.
inline double roughness_of_alpha(double alpha) { return std::sqrt(std::clamp(alpha, 0.0, 1.0)); }

// Adds "n" and "k", or the name, of a metal.
void add_metal(SceneWriter& scene, SceneJson& material, const std::string& symbol);
// Indices of a metal that reflects `reflectance` along the normal, with n = 1: k = 2 sqrt(r / (1 - r)), as in
// pbrt-v4.
SceneJson extinction_json(SceneWriter& scene, const Vec3d& reflectance);

// Pane of glass without thickness: light passes straight on, with the share that neither side reflects along
// the normal. Adds a note.
SceneJson pane_json(SceneWriter& scene, double ior);

}  // namespace orrery
