#include "server/http/request_id.h"

#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace orrery {

std::string make_request_id() {
  std::array<std::uint8_t, 8> bytes{};
  [[maybe_unused]] const ssize_t filled = getrandom(bytes.data(), bytes.size(), 0);  // 8 bytes always come
  std::string id;
  for (const std::uint8_t byte : bytes) {
    id += "0123456789abcdef"[byte >> 4];
    id += "0123456789abcdef"[byte & 15];
  }
  return id;
}

bool is_request_id(std::string_view text) {
  return !text.empty() && text.size() <= 64 && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.' ||
           c == '_' || c == '-';
  });
}

}  // namespace orrery
