#pragma once

#include <string>
#include <string_view>

namespace orrery {

// Returns two lower-case hexadecimal digits per byte.
std::string hex_of(std::string_view bytes);

// Returns the SHA-256 (FIPS 180-4) of the bytes as 64 lower-case hexadecimal digits. Thread-safe.
std::string sha256_hex(std::string_view bytes);

// Returns whether the text has the form of a sha256_hex() result.
bool is_sha256_hex(std::string_view text);

// Returns the HMAC-SHA-256 (RFC 2104) of the bytes as 64 lower-case hexadecimal digits. Thread-safe.
std::string hmac_sha256_hex(std::string_view key, std::string_view bytes);

// Returns whether two strings are equal. The time depends only on their lengths, not on their bytes.
bool equal_in_constant_time(std::string_view a, std::string_view b);

}  // namespace orrery
