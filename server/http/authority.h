#pragma once

#include <string_view>

namespace orrery {

// Whether this is what a Host header or an absolute target may name: host, or host:port (RFC 3986, 3.2.2 and
// 3.2.3), without user information. The host is a name, an IPv4 address or an IPv6 address in brackets, and
// is not empty (RFC 9110, 4.2.1); the port may be.
bool is_authority(std::string_view text);

}  // namespace orrery
