#pragma once

#include <string_view>

namespace orrery {

// Returns the instruction level of the ray tracing code ("x86-64-v3"; "plain" off x86-64). It affects speed,
// but not images.
std::string_view instruction_level();

}  // namespace orrery
