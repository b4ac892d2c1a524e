#include "server/scheduler/handler_slots.h"

#include <gtest/gtest.h>
#include <poll.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "core/base/error.h"
#include "core/base/task_scope.h"
#include "tests/support/eventually.h"

// Tests the limit on concurrent handlers and the order in which waiting ones get a slot.
namespace orrery {
namespace {

// Handlers that wait for a slot, each on its own thread. Records the order in which they get one.
class Queue {
 public:
  explicit Queue(HandlerSlots& slots) : slots_(slots) {}
  ~Queue() {
    for (auto& source : gone_) source.request_stop();
    threads_.clear();
  }

  // Starts a handler and returns once it waits.
  void add(const std::string& client) {
    const std::size_t before = slots_.waiting();
    std::stop_source& gone = gone_.emplace_back();
    threads_.emplace_back([this, client, token = gone.get_token()] {
      WaitState state(POLLIN);
      state.end();
      try {
        const HandlerSlots::Handler handler(slots_, client, token, state);
        const std::lock_guard lock(mutex_);
        order_ += client;
      } catch (const Cancelled&) {
        ++cancelled_;
      }
    });
    EXPECT_TRUE(test::eventually([&] { return slots_.waiting() == before + 1; }));
  }
  void leave(std::size_t i) { gone_[i].request_stop(); }
  std::string order() {
    threads_.clear();
    return order_;
  }
  int cancelled() const { return cancelled_; }

 private:
  HandlerSlots& slots_;
  std::mutex mutex_;
  std::string order_;  // guarded by mutex_
  std::atomic<int> cancelled_{0};
  std::deque<std::stop_source> gone_;
  std::vector<std::jthread> threads_;
};

struct Running {
  Running(HandlerSlots& slots, const std::string& client, const std::stop_token& gone = {}) {
    state.end();
    handler.emplace(slots, client, gone, state);
  }
  WaitState state{POLLIN};
  std::optional<HandlerSlots::Handler> handler;
};

TEST(HandlerSlots, ServesClientsRoundRobin) {
  HandlerSlots slots(1);
  Queue queue(slots);
  {
    const Running first(slots, "a");
    for (const char* client : {"a", "a", "a", "a", "b", "b", "c"}) queue.add(client);
  }
  EXPECT_EQ(queue.order(), "abcabaa");
}

TEST(HandlerSlots, LimitsConcurrentHandlers) {
  HandlerSlots slots(3);
  std::atomic<int> running{0}, most{0};
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 24; ++i)
      threads.emplace_back([&, i] {
        Running one(slots, std::to_string(i % 4));
        for (int step = 0; step < 20; ++step) {
          const int now = ++running;
          for (int seen = most; seen < now && !most.compare_exchange_weak(seen, now);) {
          }
          std::this_thread::yield();
          --running;
          const HandlerSlots::Wait wait;
        }
      });
  }
  EXPECT_GE(most, 1);
  EXPECT_LE(most, 3);
}

TEST(HandlerSlots, ReleasesSlotDuringWait) {
  HandlerSlots slots(1);
  const Running first(slots, "a");
  Queue queue(slots);
  queue.add("b");
  {
    const HandlerSlots::Wait wait;
    EXPECT_EQ(first.state.was_evicted(), false);
    EXPECT_EQ(queue.order(), "b");
  }
  queue.add("c");  // waits, because the first handler has its slot again
}

TEST(HandlerSlots, YieldsSlotDuringLongWork) {
  HandlerSlots slots(1);
  const Running first(slots, "a");
  Queue queue(slots);
  queue.add("b");
  EXPECT_TRUE(test::eventually([&] {
    checkpoint();
    return slots.waiting() == 0;
  }));
  EXPECT_EQ(queue.order(), "b");
}

TEST(HandlerSlots, ReleasesSlotUntilResumed) {
  HandlerSlots slots(1);
  Running first(slots, "a");
  {
    HandlerSlots::Wait wait;
    wait.end_without_slot();
  }
  { const Running second(slots, "b"); }  // would wait forever if the slot were not free
  HandlerSlots::resume();
  Queue queue(slots);
  queue.add("c");
  first.handler.reset();
  EXPECT_EQ(queue.order(), "c");
}

TEST(HandlerSlots, RemovesDisconnectedClientsFromQueue) {
  HandlerSlots slots(1);
  Queue queue(slots);
  {
    const Running first(slots, "a");
    queue.add("b");
    queue.add("b");
    queue.leave(0);
    EXPECT_TRUE(test::eventually([&] { return queue.cancelled() == 1; }));
    EXPECT_EQ(slots.waiting(), 1u);
  }
  EXPECT_EQ(queue.order(), "b");
}

TEST(HandlerSlots, ReportsWaitKindForEviction) {
  HandlerSlots slots(1);
  Running first(slots, "a");
  EXPECT_EQ(first.state.kind(), std::nullopt);
  {
    const HandlerSlots::Wait wait;
    EXPECT_EQ(first.state.kind(), WaitState::Kind::turn);
    EXPECT_FALSE(first.state.evict(WaitState::Kind::begun));
    EXPECT_TRUE(first.state.evict(WaitState::Kind::turn));
    EXPECT_FALSE(first.state.evict(WaitState::Kind::turn)) << "evicted only once";
  }
  EXPECT_TRUE(first.state.was_evicted());
}

}  // namespace
}  // namespace orrery
