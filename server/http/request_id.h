#pragma once

#include <string>
#include <string_view>

namespace orrery {

// 16 hexadecimal digits, different each time.
std::string make_request_id();

// Whether a client's own id may be used: 1 to 64 letters, digits, dots, underscores and hyphens.
bool is_request_id(std::string_view text);

}  // namespace orrery
