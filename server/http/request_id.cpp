#include "server/http/request_id.h"

#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace orrery {

std::string random_hex(std::size_t bytes) {
  std::array<std::uint8_t, 64> random{};
  [[maybe_unused]] const ssize_t filled = getrandom(random.data(), bytes, 0);  // so few always come
  std::string id;
  for (std::size_t i = 0; i < bytes; ++i) {
    id += "0123456789abcdef"[random[i] >> 4];
    id += "0123456789abcdef"[random[i] & 15];
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
