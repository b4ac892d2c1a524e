#include "server/http/process_limits.h"

#include <sys/resource.h>

#include <algorithm>
#include <limits>

#include "server/http/overload_responder.h"

namespace orrery {

std::size_t descriptors_for(std::size_t connections) {
  constexpr std::size_t kOthers = 64;
  return connections + kHealthConnections + 2 * OverloadResponder::kMost + kOthers;
}

std::size_t allow_descriptors(std::size_t count) {
  rlimit limit{};
  getrlimit(RLIMIT_NOFILE, &limit);
  if (limit.rlim_cur >= count) return limit.rlim_cur;
  limit.rlim_cur = std::min<rlim_t>(count, limit.rlim_max);
  setrlimit(RLIMIT_NOFILE, &limit);
  getrlimit(RLIMIT_NOFILE, &limit);  // setrlimit() may have failed
  return limit.rlim_cur;
}

std::size_t allowed_addresses() {
  rlimit limit{};
  getrlimit(RLIMIT_AS, &limit);
  return limit.rlim_cur == RLIM_INFINITY ? std::numeric_limits<std::size_t>::max() : limit.rlim_cur;
}

std::size_t addresses_for(std::size_t connections, std::size_t renderers) {
  constexpr std::size_t kProgram = 256 << 20, kUsualStack = 8 << 20;
  constexpr std::size_t kOthers = 8;  // accept, signals, timers and others
  // Each render thread has a second thread for background work. A step that yields blocks its thread, so that
  // one more thread runs in its place.
  const std::size_t threads = connections + kHealthConnections + 4 * renderers + kOthers;
  rlimit stack{};
  getrlimit(RLIMIT_STACK, &stack);
  return kProgram + threads * (stack.rlim_cur == RLIM_INFINITY ? kUsualStack : stack.rlim_cur);
}

}  // namespace orrery
