#pragma once

#include <atomic>

#include "server/base/timer.h"

namespace orrery {

// Timer whose time changes only by advance(), which runs due alarms in order on the calling thread.
class ManualTimer : public Timer {
 public:
  Clock::time_point now() const override { return now_; }

  void advance(Clock::duration by) {
    std::unique_lock lock(mutex());
    const auto until = now() + by;
    while (next_due() <= until) {
      now_ = next_due();
      do_first(lock, now_);
    }
    now_ = until;
  }
  // Advances to the next alarm. Requires one to be set.
  void advance_to_next() {
    std::unique_lock lock(mutex());
    now_ = next_due();
    while (do_first(lock, now_)) continue;
  }

  // Waits until an alarm is due by `time`. Use it if another thread sets the alarm.
  void await_alarm_by(Clock::time_point time) {
    std::unique_lock lock(mutex());
    changed_.wait(lock, [&] { return next_due() <= time; });
  }

 private:
  void next_changed() override { changed_.notify_all(); }

  std::atomic<Clock::time_point> now_{Clock::time_point(std::chrono::hours(1))};  // written with mutex() held
  std::condition_variable changed_;
};

}  // namespace orrery
