#pragma once

#include <atomic>
#include <chrono>
#include <stop_token>

#include "core/base/error.h"
#include "server/app/timer.h"

namespace orrery {

// The work took longer than it may.
class TimedOut : public Error {
 public:
  using Error::Error;
};

// Stops the work for a request early: once the client has gone, its time is up, or the service ends. Safe
// from any thread.
class Watch {
 public:
  struct Limit {
    std::chrono::seconds time;
    const char* name;  // in /v1/limits
  };
  // The limit counts from `since`. `timer` must outlive the watch.
  Watch(const std::stop_token& gone, const std::stop_token& service_ends, Timer& timer,
        Clock::time_point since, const Limit& limit);

  // Requested by what comes first.
  std::stop_token stop() const { return source_.get_token(); }

  // Throws what came first: Cancelled, Busy or TimedOut.
  [[noreturn]] void explain() const;

 private:
  enum class Reason { none, gone, service_ends, time };
  struct Stop {
    Watch& watch;
    Reason reason;
    void operator()() const;
  };

  const Limit limit_;
  std::stop_source source_;
  std::atomic<Reason> reason_{Reason::none};
  // Last: these use the others.
  const std::stop_callback<Stop> on_gone_, on_end_;
  const Timer::Alarm on_time_;
};

}  // namespace orrery
