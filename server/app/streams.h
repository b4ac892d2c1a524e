#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace orrery {

// Limit on long-lived responses such as event streams. Each holds a connection, and together they may hold
// three quarters of all connections. Safe from any thread.
class Streams {
 public:
  explicit Streams(std::size_t connections)
      : max_(std::max(1, static_cast<int>(connections - (connections + 3) / 4))) {}

  // Opens a stream for the client, as long as the returned object lives. Throws LimitExceeded or
  // ClientLimitExceeded if there are too many.
  std::shared_ptr<const void> open(const std::string& client);

 private:
  class Slot;

  const int max_;
  std::mutex mutex_;
  std::map<std::string, int> by_client_;  // guarded by mutex_
  int all_ = 0;                           // guarded by mutex_
};

}  // namespace orrery
