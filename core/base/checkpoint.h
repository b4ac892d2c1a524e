#pragma once

#include <stop_token>
#include <utility>

namespace orrery {

// Time slice of a task that runs on a thread for which other tasks may be waiting.
class TimeSlice {
 public:
  // Blocks until the task may continue. Returns at once if the time slice is not used up or no other task is
  // waiting.
  virtual void yield() = 0;

 protected:
  ~TimeSlice() = default;
};

// Cancellation and scheduling check. Long computations call may_continue() every few milliseconds and stop
// when it returns false.
class Checkpoint {
 public:
  Checkpoint() = default;
  // `turn` may be null; otherwise it must outlive the checkpoint.
  Checkpoint(std::stop_token stop, TimeSlice* turn = nullptr) : stop_(std::move(stop)), turn_(turn) {}

  // Yields to waiting tasks if the time slice is used up. Returns false if a stop was requested.
  bool may_continue() const {
    if (turn_) turn_->yield();
    return !stop_.stop_requested();
  }

 private:
  std::stop_token stop_;
  TimeSlice* turn_ = nullptr;
};

}  // namespace orrery
