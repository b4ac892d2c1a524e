#pragma once

#include <string_view>

namespace orrery {

// The instruction level of the code that traces rays ("x86-64-v3"; "plain" off x86-64). Speed depends on it,
// pictures do not.
std::string_view instruction_level();

}  // namespace orrery
