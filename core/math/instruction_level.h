#pragma once

#include <string_view>

namespace orrery {

// Returns the instruction level of the ray tracing code, such as "x86-64-v3", or "plain" on other
// architectures. The level affects speed, but not images.
std::string_view instruction_level();

}  // namespace orrery
