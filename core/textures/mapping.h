#pragma once

#include "core/model/texture.h"

namespace orrery {

// Reads the mapping of a texture from the member "mapping" of `p`; default: uv.
TextureMapping read_mapping(Params& p);

}  // namespace orrery
