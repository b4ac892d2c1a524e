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
#include "server/http/wait_state.h"

namespace orrery {

// Limits how many handlers compute at once on the connections' threads. A handler holds a slot while it
// computes, but not while it waits for its client or for other threads. Free slots go round-robin to the
// clients with waiting handlers, and in order of arrival within a client. A burst of requests delays another
// client's request by at most one handler of each client. Thread-safe.
class HandlerSlots {
 public:
  explicit HandlerSlots(std::size_t slots) : free_(slots) {}
  HandlerSlots(const HandlerSlots&) = delete;

  // Slot holder of one request, for the thread that runs it. Holds a slot for its lifetime, except while a
  // Wait exists on the same thread. Yields at interruption points.
  class Handler final : public TimeSlice {
   public:
    // Waits for a slot. Throws Cancelled if `gone` is requested first. `state` shows the wait to other
    // threads. `slots` and `state` must outlive the handler.
    Handler(HandlerSlots& slots, std::string client, std::stop_token gone, WaitState& state);
    ~Handler();
    Handler(const Handler&) = delete;

    // Yields the slot if other handlers wait and the thread has held it for 5 ms. Does nothing on other
    // threads.
    void yield() override;

   private:
    friend class HandlerSlots;
    // Returns without a slot if `gone_` is requested.
    void acquire();
    void release();

    HandlerSlots& slots_;
    const std::string client_;
    const std::stop_token gone_;
    WaitState& state_;
    Handler* const outer_;  // previous handler of the thread
    const TaskScope scope_{{nullptr, nullptr, this}};
    bool has_slot_ = false, has_begun_ = false;
    std::chrono::steady_clock::time_point since_;  // start of holding the slot
  };

  // Releases the slot of the thread's handler, if any, while the thread waits.
  class Wait {
   public:
    // Kind::client: the connection shows the wait itself.
    explicit Wait(WaitState::Kind kind = WaitState::Kind::turn);
    ~Wait();  // takes a slot again
    Wait(const Wait&) = delete;
    // Ends the wait without taking a slot, because its end already limits the number of computing threads.
    void end_without_slot();

   private:
    Handler* const handler_;  // null if the thread runs none
    const bool shown_;        // whether the handler's state shows the wait
    bool ended_ = false;
  };

  // Takes a slot again after Wait::end_without_slot().
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

  // Returns true if a slot was granted. `goes_on`: the handler has begun and queues before others of its
  // client.
  bool take(const std::string& client, const std::stop_token& gone, bool goes_on);
  void give_back();
  void remove(const std::string& client, Waiter& waiter);  // requires mutex_

  mutable std::mutex mutex_;             // guards the members below
  std::size_t free_;                     // 0 while a handler waits
  std::list<Client> clients_;            // clients with waiting handlers, next first
  std::atomic<std::size_t> waiting_{0};  // waiting handlers; written with mutex_ held
};

}  // namespace orrery
