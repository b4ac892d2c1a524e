#pragma once

#include <string_view>

namespace orrery {

// Whether `text` is valid in a Host header or an absolute target: host or host:port (RFC 3986, 3.2.2 and
// 3.2.3) without user information. The host is a name, an IPv4 address or an IPv6 address in brackets. An
// empty host is invalid (RFC 9110, 4.2.1). An empty port is valid.
bool is_authority(std::string_view text);

// Whether `text` is an origin as browsers send it (RFC 6454, 6.1): scheme://host or scheme://host:port, in
// lower case and without a path.
bool is_origin(std::string_view text);

// Whether the host of `text` is an IP address or localhost. DNS rebinding needs another domain name.
// REQUIRES: is_authority(text).
bool is_address_or_localhost(std::string_view text);

}  // namespace orrery
