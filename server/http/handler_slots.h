#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <list>
#include <mutex>
#include <stop_token>
#include <string>

#include "core/base/work_scope.h"
#include "server/http/waiting.h"

namespace orrery {

// Limits how many handlers compute at once on their connections' threads. A handler holds a slot while it
// computes, and none while it waits for its client or for other threads. Free slots go round-robin to the
// clients that have handlers waiting, and in order of arrival within a client. A burst of requests therefore
// delays a request of another client by one handler of each client at most. Safe from any thread.
class HandlerSlots {
 public:
  explicit HandlerSlots(std::size_t slots) : free_(slots) {}
  HandlerSlots(const HandlerSlots&) = delete;

  // The handler of one request, for the thread that runs it. Holds a slot from its construction to its end,
  // except while a Wait lives on the same thread. What it computes gives way at interruption points.
  class Handler final : public Turn {
   public:
    // Waits for a slot, at most until `gone` is requested; throws Cancelled then. `state` shows others that
    // it waits; both outlive the handler.
    Handler(HandlerSlots& slots, std::string client, std::stop_token gone, Waiting& state);
    ~Handler();
    Handler(const Handler&) = delete;

    // Lets other clients go first if the thread has held its slot for a while. Other threads have none.
    void give_way() override;

   private:
    friend class HandlerSlots;
    // Returns without a slot once `gone_` is requested.
    void acquire();
    void release();

    HandlerSlots& slots_;
    const std::string client_;
    const std::stop_token gone_;
    Waiting& state_;
    Handler* const outer_;  // of the thread, before
    const WorkScope scope_{{nullptr, nullptr, this}};
    bool has_slot_ = false, has_begun_ = false;
    std::chrono::steady_clock::time_point since_;  // it has the slot
  };

  // The thread waits as long as this lives, and its handler, if it has one, holds no slot.
  class Wait {
   public:
    // Of the kind client: the connection shows that it waits.
    explicit Wait(Waiting::Kind kind = Waiting::Kind::turn);
    ~Wait();  // waits for a slot again
    Wait(const Wait&) = delete;
    // Ends the wait without taking a slot: what the thread waited for bounds how many compute.
    void end_without_slot();

   private:
    Handler* const handler_;  // null: the thread runs none
    const bool shown_;        // by the handler's state
    bool ended_ = false;
  };

  // Takes a slot again after Wait::end_without_slot().
  static void resume();
  // Has the thread's handler give way, if there is one.
  static void give_way();

  std::size_t waiting() const { return waiting_; }

 private:
  struct Waiter {
    bool granted = false;
    std::condition_variable_any changed;
  };
  struct Client {
    std::string name;
    std::deque<Waiter*> waiters;  // the next first; never empty
  };

  // Whether it got a slot. Handlers that go on come before those of the same client that begin.
  bool take(const std::string& client, const std::stop_token& gone, bool goes_on);
  void give_back();
  void remove(const std::string& client, Waiter& waiter);  // with mutex_ held

  mutable std::mutex mutex_;             // guards all below
  std::size_t free_;                     // 0 while anybody waits
  std::list<Client> clients_;            // that wait, the next first
  std::atomic<std::size_t> waiting_{0};  // handlers; changes with mutex_ held
};

}  // namespace orrery
