#pragma once

#include <string>
#include <vector>

namespace orrery {

// Bytes that a client sends, and the expected statuses of the responses. The daemon closes the connection
// after the last response.
struct RawCase {
  const char* name;
  std::string bytes;
  std::vector<int> statuses;
};

// Cases of malformed_framing.cpp, malformed_head.cpp and malformed_meaning.cpp.
std::vector<RawCase> framing_cases();  // message framing
std::vector<RawCase> head_cases();     // request lines and headers
std::vector<RawCase> meaning_cases();  // valid syntax that must be rejected, ignored or limited

inline constexpr const char* kHost = "Host: x\r\n";
inline constexpr const char* kClose = "Connection: close\r\n";

}  // namespace orrery
