#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <list>
#include <mutex>
#include <stop_token>
#include <string>

#include "core/base/task_scope.h"
#include "server/scheduler/wait_state.h"

namespace orrery {

// Limits how many handlers compute at the same time on connection threads. A handler holds a handler slot
// while it computes, but not while it waits for its client or for other threads. Free slots go round-robin to
// the clients with waiting handlers, and to each client's handlers in order of arrival. A burst of requests
// delays another client's request by at most one handler of each client. Thread-safe.
class HandlerSlots {
 public:
  explicit HandlerSlots(std::size_t slots) : free_(slots) {}
  HandlerSlots(const HandlerSlots&) = delete;

  // Handler of one request, used by the thread that runs it. Holds a slot for its lifetime, except while a
  // Wait exists on the same thread. Yields at checkpoints.
  class Handler final : public TimeSlice {
   public:
    // Waits for a slot. Throws Cancelled if a stop of `gone` is requested first. `state` shows the wait to
    // other threads. `slots` and `state` must outlive the handler.
    Handler(HandlerSlots& slots, std::string client, std::stop_token gone, WaitState& state);
    ~Handler();
    Handler(const Handler&) = delete;

    // Yields the slot if other handlers wait and this handler has held it for 5 ms. Does nothing on a thread
    // that runs another handler or none.
    void yield() override;

   private:
    friend class HandlerSlots;
    // Waits for a slot. Returns without one if a stop of `gone_` is requested.
    void acquire();
    void release();

    HandlerSlots& slots_;
    const std::string client_;
    const std::stop_token gone_;
    WaitState& state_;
    Handler* const outer_;  // enclosing handler of the thread, or null
    const TaskScope scope_{{nullptr, nullptr, this}};
    bool has_slot_ = false, has_begun_ = false;
    std::chrono::steady_clock::time_point since_;  // time when the slot was acquired
  };

  // Releases the slot of the thread's handler, if any, while the thread waits.
  class Wait {
   public:
    // With Kind::client, the connection itself shows the wait to other threads.
    explicit Wait(WaitState::Kind kind = WaitState::Kind::turn);
    ~Wait();  // acquires a slot again
    Wait(const Wait&) = delete;
    // Ends the wait without acquiring a slot. For waits for Admission, which itself limits the number of
    // computing threads.
    void end_without_slot();

   private:
    Handler* const handler_;  // null if the thread runs no handler
    const bool shown_;        // whether the handler's state shows the wait
    bool ended_ = false;
  };

  // Acquires a slot again after Wait::end_without_slot().
  static void resume();
  // Yields the slot of the thread's handler, if any; see Handler::yield().
  static void yield();

  std::size_t waiting() const { return waiting_; }

 private:
  struct Waiter {
    bool granted = false;
    std::condition_variable_any changed;
  };
  struct Client {
    std::string name;
    std::deque<Waiter*> waiters;  // next first; never empty
  };

  // Waits for a slot. Returns false if a stop of `gone` is requested first. `goes_on`: the handler has
  // already computed, and queues before other handlers of its client.
  bool take(const std::string& client, const std::stop_token& gone, bool goes_on);
  void give_back();
  void remove(const std::string& client, Waiter& waiter);  // requires mutex_

  mutable std::mutex mutex_;             // guards the members below
  std::size_t free_;                     // 0 while a handler waits
  std::list<Client> clients_;            // clients with waiting handlers, next first
  std::atomic<std::size_t> waiting_{0};  // waiting handlers; written with mutex_ held
};

}  // namespace orrery
