#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace orrery {

// Pool with a thread for each connection. Threads start when needed and are reused. A few extra threads serve
// new connections while evicted ones end. Thread-safe.
class ConnectionThreads {
 public:
  explicit ConnectionThreads(std::size_t most) : max_(most) {}
  ~ConnectionThreads();  // waits for all work to end

  // Whether fewer than `most` connections are served and a thread is free, or can be started.
  bool has_room();
  // Runs `work` on the next free thread. `work` must not throw. REQUIRES: has_room() was true, or a
  // connection has been evicted.
  void start(std::function<void()> work);

 private:
  void serve();
  bool add_thread();  // requires mutex_; returns false if the system cannot start a thread

  const std::size_t max_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  std::size_t idle_ = 0;
  bool closed_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace orrery
