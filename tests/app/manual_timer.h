#pragma once

#include <atomic>

#include "server/app/timer.h"

namespace orrery {

// A timer whose time stands still but for advance(), which does what falls due on the calling thread, in
// order.
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
  // To when the next thing is due. REQUIRES: something is.
  void advance_to_next() {
    std::unique_lock lock(mutex());
    now_ = next_due();
    while (do_first(lock, now_)) continue;
  }

  // Waits until an alarm is set for `time`, or another one by then. For tests of what waits on other threads.
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
