#pragma once

#include <string>
#include <string_view>

namespace orrery {

// Returns 2 * `bytes` random hexadecimal digits. 16 bytes or more cannot be guessed. REQUIRES: bytes <= 64.
std::string random_hex(std::size_t bytes);

inline std::string make_request_id() { return random_hex(8); }

// Whether `text` is a valid request ID of a client: 1 to 64 letters, digits, dots, underscores and hyphens.
bool is_request_id(std::string_view text);

}  // namespace orrery
