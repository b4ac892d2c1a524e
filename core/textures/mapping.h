#pragma once

#include "core/model/texture.h"

namespace orrery {

// Reads the mapping of a texture from the member "mapping" of `p`; default: uv.
TextureMapping read_mapping(Params& p);

// Returns the name of a mapping in scene JSON.
std::string_view name_of(TextureMapping::Kind kind);

}  // namespace orrery
