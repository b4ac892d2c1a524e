#pragma once

#include <condition_variable>
#include <mutex>
#include <stop_token>

namespace orrery {

// Mutex for long critical sections. Waiting threads can be cancelled. Meets BasicLockable.
class StoppableMutex {
 public:
  void lock() { lock_unless({}); }

  // Locks the mutex and returns true. Returns false if a stop is requested while another thread holds the
  // mutex.
  bool lock_unless(const std::stop_token& stop) {
    std::unique_lock guard(mutex_);
    if (!changed_.wait(guard, stop, [&] { return !held_; })) return false;
    held_ = true;
    return true;
  }

  void unlock() {
    const std::lock_guard guard(mutex_);
    held_ = false;
    changed_.notify_one();
  }

 private:
  std::mutex mutex_;
  std::condition_variable_any changed_;
  bool held_ = false;  // guarded by mutex_
};

}  // namespace orrery
