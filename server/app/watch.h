#pragma once

#include <atomic>
#include <chrono>
#include <functional>

#include "core/base/clock.h"
#include "core/base/error.h"

namespace orrery {

// The work took longer than it may.
class TimedOut : public Error {
 public:
  using Error::Error;
};

// Says when the work for a request should end early: the client has gone, its time is up, or the program
// ends. Safe from any thread.
class Watch {
 public:
  // limit_name: in /v1/limits. The limit counts from `since`.
  Watch(std::function<bool()> gone, const std::atomic<bool>& program_ends, std::chrono::seconds limit,
        const char* limit_name, Clock::time_point since = Clock::now())
      : gone_(std::move(gone)),
        program_ends_(program_ends),
        limit_(limit),
        limit_name_(limit_name),
        deadline_(since + limit) {}

  // Cheap: asks whether the client has gone every 5 ms, not each time.
  bool stop() const;

  // Throws what stop() was true for: Cancelled, TimedOut or Busy.
  [[noreturn]] void explain() const;

 private:
  const std::function<bool()> gone_;
  const std::atomic<bool>& program_ends_;
  const std::chrono::seconds limit_;
  const char* const limit_name_;
  const Clock::time_point deadline_;
  mutable std::atomic<Clock::time_point> ask_at_{};
  mutable std::atomic<bool> has_gone_{false};
};

}  // namespace orrery
