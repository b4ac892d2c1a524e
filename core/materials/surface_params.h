#pragma once

#include <optional>
#include <vector>

#include "core/model/texture.h"

namespace orrery {

class Params;

// Parameters that every material has.
struct SurfaceParams {
  Vec3d emission;      // radiance on both sides, per channel; the largest value of a texture
  double opacity = 1;  // the smallest value of a texture
  // Opacity below which rays pass. nullopt: rays pass with a probability of 1 - opacity.
  std::optional<double> alpha_cutoff;
  std::vector<TextureUse> uses;  // without material numbers
};

// Reads the parameters. Records problems in `p`.
SurfaceParams read_surface_params(Params& p, const TextureNames& textures);

}  // namespace orrery
