#pragma once

#include <stop_token>

namespace orrery::test {

// A token of which a stop has been requested.
inline std::stop_token stopped() {
  std::stop_source source;
  source.request_stop();
  return source.get_token();
}

}  // namespace orrery::test
