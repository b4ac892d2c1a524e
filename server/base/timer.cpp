#include "server/base/timer.h"

namespace orrery {

Timer::Alarm Timer::at(Clock::time_point when, Action action) {
  const bool late = now() >= when;
  std::unique_lock lock(mutex_);
  const std::uint64_t number = ++last_number_;
  if (!late) {
    const auto entry = alarms_.emplace(Key(when, number), std::move(action)).first;
    if (entry == alarms_.begin()) next_changed();
    return Alarm(*this, number, when);
  }
  lock.unlock();
  action();
  return Alarm(*this, number, when);
}

bool Timer::do_first(Lock& lock, Clock::time_point time) {
  if (alarms_.empty() || alarms_.begin()->first.first > time) return false;
  const auto entry = alarms_.extract(alarms_.begin());
  being_done_ = entry.key().second;
  doer_ = std::this_thread::get_id();
  lock.unlock();
  entry.mapped()();
  lock.lock();
  being_done_ = 0;
  doer_ = {};
  done_.notify_all();
  return true;
}

Clock::time_point Timer::next_due() const {
  return alarms_.empty() ? Clock::time_point::max() : alarms_.begin()->first.first;
}

void Timer::cancel(const Key& key) {
  std::unique_lock lock(mutex_);
  if (alarms_.erase(key) > 0 || doer_ == std::this_thread::get_id()) return;
  done_.wait(lock, [&] { return being_done_ != key.second; });
}

SteadyTimer::SteadyTimer() : thread_([this] { run(); }) {}

SteadyTimer::~SteadyTimer() {
  {
    const std::lock_guard lock(mutex());
    ends_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void SteadyTimer::run() {
  std::unique_lock lock(mutex());
  while (!ends_) {
    if (do_first(lock, now())) continue;
    const auto due = next_due();
    if (due == Clock::time_point::max())
      changed_.wait(lock);
    else
      changed_.wait_until(lock, due);
  }
}

}  // namespace orrery
