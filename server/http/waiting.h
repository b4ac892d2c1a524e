#pragma once

#include <atomic>
#include <chrono>
#include <optional>

namespace orrery {

// What other threads may know of a connection's thread while it waits: for what, and since when. They may
// tell it to give up, but only while it waits. begin(), begin_turn(), end() and gave_up() are for that
// thread, the rest for any.
class Waiting {
 public:
  using Clock = std::chrono::steady_clock;
  // client: for bytes from the client, or for it to take some. turn: for other threads, before its work
  // begins. begun: the same for work or a stream that has begun.
  enum class Kind { client, turn, begun };

  // It waits from the start for its client, for what `events` say.
  explicit Waiting(short events) : events_(events) {}

  // Waits for the client. Both are false once it was told to give up.
  bool begin(Clock::time_point since, short events) {
    since_ = since.time_since_epoch().count();
    events_ = events;
    return change(State::working, State::client) || state_ == State::client;
  }
  bool end() {
    State state = state_;
    while (state != State::given_up && !state_.compare_exchange_weak(state, State::working)) {
    }
    return state != State::given_up;
  }
  bool gave_up() const { return state_ == State::given_up; }
  // Waits for other threads.
  void begin_turn(Kind kind) {
    since_ = Clock::now().time_since_epoch().count();
    change(State::working, kind == Kind::turn ? State::turn : State::begun);
  }

  // Nullopt if it does not wait.
  std::optional<Kind> kind() const {
    switch (state_.load()) {
      case State::client: return Kind::client;
      case State::turn: return Kind::turn;
      case State::begun: return Kind::begun;
      default: return std::nullopt;
    }
  }
  Clock::time_point since() const { return Clock::time_point(Clock::duration(since_)); }
  short events() const { return events_; }
  // False if it does not wait for that any more.
  bool give_up(Kind kind) {
    return change(kind == Kind::client ? State::client
                  : kind == Kind::turn ? State::turn
                                       : State::begun,
                  State::given_up);
  }

 private:
  enum class State { working, client, turn, begun, given_up };
  bool change(State from, State to) { return state_.compare_exchange_strong(from, to); }

  std::atomic<Clock::rep> since_{Clock::now().time_since_epoch().count()};
  std::atomic<short> events_;
  std::atomic<State> state_{State::client};
};

}  // namespace orrery
