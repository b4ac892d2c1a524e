#pragma once

#include <atomic>
#include <chrono>
#include <optional>

namespace orrery {

// What others may know of a thread that waits for its client: since when, and for what. They may tell it to
// give up, but only while it waits. begin(), end() and gave_up() are for that thread, the rest for any.
class Waiting {
 public:
  using Clock = std::chrono::steady_clock;

  // It waits from the start, for what `events` say.
  explicit Waiting(short events) : events_(events) {}

  // Both are false once it was told to give up.
  bool begin(Clock::time_point since, short events) {
    since_ = since.time_since_epoch().count();
    events_ = events;
    return change(State::working, State::waiting) || state_ == State::waiting;
  }
  bool end() { return change(State::waiting, State::working); }
  bool gave_up() const { return state_ == State::given_up; }

  // None: it does not wait.
  std::optional<Clock::time_point> since() const {
    if (state_ != State::waiting) return std::nullopt;
    return Clock::time_point(Clock::duration(since_));
  }
  short events() const { return events_; }
  // False: it does not wait any more.
  bool give_up() { return change(State::waiting, State::given_up); }

 private:
  enum class State { working, waiting, given_up };
  bool change(State from, State to) { return state_.compare_exchange_strong(from, to); }

  std::atomic<Clock::rep> since_{Clock::now().time_since_epoch().count()};
  std::atomic<short> events_;
  std::atomic<State> state_{State::waiting};
};

}  // namespace orrery
