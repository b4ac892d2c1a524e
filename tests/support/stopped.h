#pragma once

#include <stop_token>

namespace orrery::test {

// Returns a token with a stop request.
inline std::stop_token stopped() {
  std::stop_source source;
  source.request_stop();
  return source.get_token();
}

}  // namespace orrery::test
