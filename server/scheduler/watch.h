#pragma once

#include <atomic>
#include <chrono>
#include <stop_token>

#include "core/base/error.h"
#include "server/base/timer.h"

namespace orrery {

// Thrown for work that exceeds its time limit.
class TimedOut : public Error {
 public:
  using Error::Error;
};

// Cancels the work of a request once its client disconnects, its time limit expires or the service ends.
// Thread-safe.
class WorkCancellation {
 public:
  struct Limit {
    std::chrono::seconds time;
    const char* name;  // name in /v1/limits
  };
  // The time limit starts at `since`. `timer` must outlive this object.
  WorkCancellation(const std::stop_token& gone, const std::stop_token& service_ends, Timer& timer,
                   Clock::time_point since, const Limit& limit);

  // Returns a token that is stopped by the first of these events.
  std::stop_token stop() const { return source_.get_token(); }

  // Returns work(stop()). If that throws Cancelled, throws the error of explain() instead.
  template <class Work>
  auto run(const Work& work) const {
    try {
      return work(stop());
    } catch (const Cancelled&) {
      explain();
    }
  }

  // Throws the error for the first event: Cancelled, Busy or TimedOut.
  [[noreturn]] void explain() const;

 private:
  enum class Reason { none, gone, service_ends, time };
  struct Stop {
    WorkCancellation& watch;
    Reason reason;
    void operator()() const;
  };

  const Limit limit_;
  std::stop_source source_;
  std::atomic<Reason> reason_{Reason::none};
  // Last: these use the members above.
  const std::stop_callback<Stop> on_gone_, on_end_;
  const Timer::Alarm on_time_;
};

}  // namespace orrery
