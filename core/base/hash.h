#pragma once

#include <string>
#include <string_view>

namespace orrery {

// Two lower-case hexadecimal digits a byte.
std::string hex_of(std::string_view bytes);

// SHA-256 (FIPS 180-4) of the bytes, as 64 lower-case hexadecimal digits. Safe to call from any thread.
std::string sha256_hex(std::string_view bytes);

// Whether the text can be what sha256_hex() returns.
bool is_sha256_hex(std::string_view text);

// HMAC-SHA-256 (RFC 2104) of the bytes under the key, likewise.
std::string hmac_sha256_hex(std::string_view key, std::string_view bytes);

// Whether both are the same, in a time that depends on their lengths alone.
bool equal_in_constant_time(std::string_view a, std::string_view b);

}  // namespace orrery
