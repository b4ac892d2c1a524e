#pragma once

#include <stop_token>
#include <utility>

namespace orrery {

// Time slice on a thread that other work may be waiting for.
class TimeSlice {
 public:
  // Blocks until this work may run again. Returns at once if the slice has been short so far or no other work
  // waits.
  virtual void yield() = 0;

 protected:
  ~TimeSlice() = default;
};

// Cancellation and scheduling check that long work calls every few milliseconds.
class Checkpoint {
 public:
  Checkpoint() = default;
  // `turn` may be null; otherwise it must outlive the checkpoint.
  Checkpoint(std::stop_token stop, TimeSlice* turn = nullptr) : stop_(std::move(stop)), turn_(turn) {}

  // Yields to waiting work if the time slice is used up. Returns false if a stop was requested.
  bool may_continue() const {
    if (turn_) turn_->yield();
    return !stop_.stop_requested();
  }

 private:
  std::stop_token stop_;
  TimeSlice* turn_ = nullptr;
};

}  // namespace orrery
