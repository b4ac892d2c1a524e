#pragma once

#include <atomic>
#include <chrono>
#include <optional>

namespace orrery {

// Wait state of a connection's thread, visible to other threads. They can evict the thread, but only while it
// waits. begin(), begin_turn(), end() and was_evicted() are for the connection's thread, the other functions
// for any thread.
class WaitState {
 public:
  using Clock = std::chrono::steady_clock;
  // client: waits for input from the client, or for the client to read. turn: waits for other threads before
  // its work begins. begun: waits for other threads during work or a stream.
  enum class Kind { client, turn, begun };

  // Starts with a wait for the client. `events`: poll() events.
  explicit WaitState(short events) : events_(events) {}

  // begin() starts a wait for the client since `since`. end() ends any wait. Both return false after an
  // eviction.
  bool begin(Clock::time_point since, short events) {
    since_ = since.time_since_epoch().count();
    events_ = events;
    return change(State::working, State::client) || state_ == State::client;
  }
  bool end() {
    State state = state_;
    while (state != State::evicted && !state_.compare_exchange_weak(state, State::working)) {
    }
    return state != State::evicted;
  }
  bool was_evicted() const { return state_ == State::evicted; }
  // Starts a wait for other threads: Kind::turn or Kind::begun.
  void begin_turn(Kind kind) {
    since_ = Clock::now().time_since_epoch().count();
    change(State::working, kind == Kind::turn ? State::turn : State::begun);
  }

  // Returns nullopt if the thread is not waiting.
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
  // Evicts the thread. Returns false if it no longer waits for `kind`.
  bool evict(Kind kind) {
    return change(kind == Kind::client ? State::client
                  : kind == Kind::turn ? State::turn
                                       : State::begun,
                  State::evicted);
  }

 private:
  enum class State { working, client, turn, begun, evicted };
  bool change(State from, State to) { return state_.compare_exchange_strong(from, to); }

  std::atomic<Clock::rep> since_{Clock::now().time_since_epoch().count()};
  std::atomic<short> events_;
  std::atomic<State> state_{State::client};
};

}  // namespace orrery
