#include "server/http/threads.h"

#include <system_error>

namespace orrery {

ConnectionThreads::~ConnectionThreads() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

bool ConnectionThreads::has_room() {
  const std::lock_guard lock(mutex_);
  if (threads_.size() - idle_ + waiting_.size() >= max_) return false;
  return idle_ > waiting_.size() || add_thread();
}

bool ConnectionThreads::add_thread() {
  try {
    threads_.emplace_back([this] { serve(); });
  } catch (const std::system_error&) {
    return false;
  }
  ++idle_;
  return true;
}

void ConnectionThreads::start(std::function<void()> work) {
  const std::lock_guard lock(mutex_);
  waiting_.push_back(std::move(work));
  const std::size_t spare = max_ / 8 + 1;
  if (idle_ < waiting_.size() && threads_.size() < max_ + spare) add_thread();
  changed_.notify_one();
}

void ConnectionThreads::serve() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return !waiting_.empty() || closed_; });
    if (waiting_.empty()) return;
    const std::function<void()> work = std::move(waiting_.front());
    waiting_.pop_front();
    --idle_;
    lock.unlock();
    work();
    lock.lock();
    ++idle_;
  }
}

}  // namespace orrery
