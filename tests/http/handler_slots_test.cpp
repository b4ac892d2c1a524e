#include "server/http/handler_slots.h"

#include <gtest/gtest.h>
#include <poll.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "core/base/error.h"
#include "core/base/work_scope.h"
#include "tests/support/eventually.h"

// How many handlers compute at once, and whose turn it is.
namespace orrery {
namespace {

// Handlers that wait for a slot, each on a thread of its own, and the order in which they got theirs.
class Queue {
 public:
  explicit Queue(HandlerSlots& slots) : slots_(slots) {}
  ~Queue() {
    for (auto& source : gone_) source.request_stop();
    threads_.clear();
  }

  // Returns once it waits.
  void add(const std::string& client) {
    const std::size_t before = slots_.waiting();
    std::stop_source& gone = gone_.emplace_back();
    threads_.emplace_back([this, client, token = gone.get_token()] {
      Waiting state(POLLIN);
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
  Waiting state{POLLIN};
  std::optional<HandlerSlots::Handler> handler;
};

TEST(HandlerSlots, GoRoundRobinToClients) {
  HandlerSlots slots(1);
  Queue queue(slots);
  {
    const Running first(slots, "a");
    for (const char* client : {"a", "a", "a", "a", "b", "b", "c"}) queue.add(client);
  }
  EXPECT_EQ(queue.order(), "abcabaa");
}

TEST(HandlerSlots, AreHeldByNoMoreHandlersThanThereAre) {
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

TEST(HandlerSlots, AreFreeWhileTheirHandlerWaits) {
  HandlerSlots slots(1);
  const Running first(slots, "a");
  Queue queue(slots);
  queue.add("b");
  {
    const HandlerSlots::Wait wait;
    EXPECT_EQ(first.state.gave_up(), false);
    EXPECT_EQ(queue.order(), "b");
  }
  queue.add("c");  // waits: the first has its slot again
}

TEST(HandlerSlots, AreGivenUpNowAndThenByLongWork) {
  HandlerSlots slots(1);
  const Running first(slots, "a");
  Queue queue(slots);
  queue.add("b");
  EXPECT_TRUE(test::eventually([&] {
    interruption_point();
    return slots.waiting() == 0;
  }));
  EXPECT_EQ(queue.order(), "b");
}

TEST(HandlerSlots, StayFreeWherePlacesOfAnotherKindBoundTheWork) {
  HandlerSlots slots(1);
  Running first(slots, "a");
  {
    HandlerSlots::Wait wait;
    wait.end_without_slot();
  }
  { const Running second(slots, "b"); }  // would wait for ever
  HandlerSlots::resume();
  Queue queue(slots);
  queue.add("c");
  first.handler.reset();
  EXPECT_EQ(queue.order(), "c");
}

TEST(HandlerSlots, AreNotWaitedForByClientsThatHaveGone) {
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

TEST(HandlerSlots, ShowWhatTheirHandlerWaitsFor) {
  HandlerSlots slots(1);
  Running first(slots, "a");
  EXPECT_EQ(first.state.kind(), std::nullopt);
  {
    const HandlerSlots::Wait wait;
    EXPECT_EQ(first.state.kind(), Waiting::Kind::turn);
    EXPECT_FALSE(first.state.give_up(Waiting::Kind::begun));
    EXPECT_TRUE(first.state.give_up(Waiting::Kind::turn));
    EXPECT_FALSE(first.state.give_up(Waiting::Kind::turn)) << "once";
  }
  EXPECT_TRUE(first.state.gave_up());
}

}  // namespace
}  // namespace orrery
