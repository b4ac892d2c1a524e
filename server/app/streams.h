#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace orrery {

// Answers that go on, such as events: each holds a connection, and so they leave a quarter of these to
// others. Safe from any thread.
class Streams {
 public:
  explicit Streams(std::size_t connections)
      : most_(std::max(1, static_cast<int>(connections - (connections + 3) / 4))) {}

  // One more for this client, as long as the object lives. Throws Busy or ClientBusy if that is too much.
  std::shared_ptr<const void> open(const std::string& client);

 private:
  class Slot;

  const int most_;
  std::mutex mutex_;
  std::map<std::string, int> by_client_;  // guarded by mutex_
  int all_ = 0;                           // likewise
};

}  // namespace orrery
