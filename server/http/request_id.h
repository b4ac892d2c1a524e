#pragma once

#include <string>
#include <string_view>

namespace orrery {

// Two hexadecimal digits a byte, different each time; from 16 bytes on nobody can guess them. REQUIRES:
// bytes <= 64.
std::string random_hex(std::size_t bytes);

inline std::string make_request_id() { return random_hex(8); }

// Whether a client's own id may be used: 1 to 64 letters, digits, dots, underscores and hyphens.
bool is_request_id(std::string_view text);

}  // namespace orrery
