#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace orrery {

// Limit on long-lived responses such as event streams. Each occupies a connection. Together they may occupy
// at most three quarters of all connections. Thread-safe.
class Streams {
 public:
  explicit Streams(std::size_t connections)
      : max_(std::max(1, static_cast<int>(connections - (connections + 3) / 4))) {}

  // Counts an open stream of the client until the returned object is destroyed. Throws LimitExceeded or
  // ClientLimitExceeded if too many streams are open.
  std::shared_ptr<const void> open(const std::string& client);

 private:
  class Slot;

  const int max_;
  std::mutex mutex_;
  std::map<std::string, int> by_client_;  // guarded by mutex_
  int all_ = 0;                           // guarded by mutex_
};

}  // namespace orrery
