#pragma once

#include <string>
#include <vector>

namespace orrery {

// Bytes that a client may send, and the statuses of the answers to them; the daemon closes after the last.
struct RawCase {
  const char* name;
  std::string bytes;
  std::vector<int> statuses;
};

// Each from a file of its own.
std::vector<RawCase> framing_cases();  // where requests end
std::vector<RawCase> head_cases();     // request lines and headers
std::vector<RawCase> meaning_cases();  // well formed, but to be refused, ignored or limited

inline constexpr const char* kHost = "Host: x\r\n";
inline constexpr const char* kClose = "Connection: close\r\n";

}  // namespace orrery
