#include "server/app/admission.h"

#include <algorithm>
#include <chrono>

#include "core/base/error.h"

namespace orrery {

int Admission::running() const {
  const std::lock_guard lock(mutex_);
  return running_;
}
int Admission::waiting() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(waiting_.size());
}
bool Admission::full() const {
  const std::lock_guard lock(mutex_);
  return overrun();
}

Admission::Ticket Admission::enter(const Stop& stop) {
  std::unique_lock lock(mutex_);
  if (overrun())
    throw Busy(std::to_string(waiting_.size()) + " renders wait already (queue)", retry_after_s());
  return wait_for_turn(lock, stop);
}

Admission::Ticket Admission::enter_again(const Stop& stop) {
  std::unique_lock lock(mutex_);
  return wait_for_turn(lock, stop);
}

Admission::Ticket Admission::wait_for_turn(std::unique_lock<std::mutex>& lock, const Stop& stop) {
  constexpr std::chrono::milliseconds kAsk{20};
  const auto place = waiting_.insert(waiting_.end(), 0);
  while (place != waiting_.begin() || running_ >= most_running_) {
    changed_.wait_for(lock, kAsk);
    lock.unlock();
    const bool give_up = stop();
    lock.lock();
    if (!give_up) continue;
    waiting_.erase(place);
    changed_.notify_all();
    throw Cancelled();
  }
  waiting_.erase(place);
  ++running_;
  changed_.notify_all();
  return Ticket(*this);
}

void Admission::leave(double milliseconds) {
  const std::lock_guard lock(mutex_);
  --running_;
  mean_ms_ += (milliseconds - mean_ms_) / 8;
  changed_.notify_all();
}

double Admission::retry_after_s() const {
  const double queued_ms = mean_ms_ * static_cast<double>(waiting_.size() + 1) / most_running_;
  return std::clamp(queued_ms / 1000, 1.0, 30.0);
}

}  // namespace orrery
