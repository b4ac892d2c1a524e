#pragma once

#include <string>
#include <string_view>

namespace orrery {

// Encodes bytes as base64 with padding (RFC 4648). REQUIRES: at most 1 GiB.
std::string encode_base64(std::string_view bytes);

}  // namespace orrery
