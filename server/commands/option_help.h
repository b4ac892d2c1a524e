#pragma once

#include <string>
#include <string_view>

#include "core/plan/options.h"

namespace orrery {

// Returns the heading of an image option in the help: "Light".
std::string_view heading_of(const RenderOption& option);
// Returns the help of an image option with its values and its default: "Image width in pixels (1-4096,
// default 600)".
std::string help_of(const RenderOption& option);

}  // namespace orrery
