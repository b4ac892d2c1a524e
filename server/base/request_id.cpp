#include "server/base/request_id.h"

#include <sys/random.h>

#include <algorithm>
#include <array>

#include "core/base/hash.h"

namespace orrery {

std::string random_hex(std::size_t bytes) {
  std::array<char, 64> random{};
  [[maybe_unused]] const ssize_t filled = getrandom(random.data(), bytes, 0);  // never fails for 64 bytes
  return hex_of({random.data(), bytes});
}

bool is_request_id(std::string_view text) {
  return !text.empty() && text.size() <= 64 && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.' ||
           c == '_' || c == '-';
  });
}

}  // namespace orrery
