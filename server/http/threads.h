#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace orrery {

// A thread a connection, made when first needed and used again. A few more serve newcomers while connections
// that were evicted for them come to their ends.
class ConnectionThreads {
 public:
  explicit ConnectionThreads(std::size_t most) : most_(most) {}
  ~ConnectionThreads();  // waits for all work to end

  // Whether fewer than `most` pieces of work are under way, and a thread is free for one more.
  bool has_room();
  // Has the work done by the first thread that is free; it throws nothing. REQUIRES: one is, or will be soon.
  void start(std::function<void()> work);

 private:
  void serve();
  bool add_thread();  // with mutex_ held; false if the machine has no more

  const std::size_t most_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  std::size_t idle_ = 0;
  bool closed_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace orrery
