#include <gtest/gtest.h>

#include <chrono>
#include <list>
#include <memory>
#include <optional>
#include <vector>

#include "server/cache/pictures.h"
#include "server/scheduler/admission.h"
#include "tests/server/manual_timer.h"
#include "tests/server/waiters.h"

// Tests admission of work that several clients share.
namespace orrery {
namespace {

using namespace std::chrono_literals;
using test::demand;
using test::kNever;
using test::TurnOrder;
using test::Waiters;

class SharedWork : public testing::Test {
 protected:
  // Queues three requests of client a, one of c, and then the shared work.
  void ask() {
    for (const char* name : {"a1", "a2", "a3"}) waiters_.add(name, demand("a"));
    waiters_.add("c", demand("c", 15));
    waiters_.add("shared", {Priority::interactive, "a", 10, subscribers_});
  }
  const TurnOrder& order() {
    ticket_.reset();
    waiters_.join();
    return order_ = waiters_.order();
  }

  ManualTimer timer_;
  Admission admission_{{.running = 1, .max_queued_rays = 1000}, timer_};
  const std::shared_ptr<Subscribers> subscribers_ = std::make_shared<Subscribers>();
  std::optional<Admission::Ticket> ticket_{admission_.enter(demand("z"), kNever)};
  Waiters waiters_{admission_};
  TurnOrder order_;
};

TEST_F(SharedWork, BelongsToFirstClientWithoutSubscribers) {
  ask();
  { const Admission::Subscription sharing(admission_, subscribers_, "b"); }
  EXPECT_EQ(order(), (TurnOrder{"a1", "c", "a2", "a3", "shared"}));  // virtual finish times: 10 15 20 30 40
}

TEST_F(SharedWork, StartsEarliestAndChargesEachSubscriber) {
  ask();
  const Admission::Subscription sharing(admission_, subscribers_, "b");
  waiters_.add("b", demand("b"));
  // Virtual finish times: 10 10 15 20 20 30.
  EXPECT_EQ(order(), (TurnOrder{"a1", "shared", "c", "a2", "b", "a3"}));
}

TEST_F(SharedWork, AcceptsSubscribersBeforeQueueing) {
  const Admission::Subscription sharing(admission_, subscribers_, "b");
  const Admission::Subscription again(admission_, subscribers_, "b");
  { const Admission::Subscription third(admission_, subscribers_, "b"); }
  ask();
  EXPECT_EQ(order(), (TurnOrder{"a1", "shared", "c", "a2", "a3"}));
}

TEST_F(SharedWork, StartsUnlessAllSubscribersAreDelayed) {
  ticket_.reset();
  std::list<Admission::Ticket> own;
  for (int i = 0; i < 2; ++i) {  // two preemptions per slot delay the client
    own.push_back(admission_.enter(demand("a"), kNever));
    timer_.advance(50ms);
    const auto other = admission_.enter(demand("c"), kNever);
  }
  waiters_.add("shared", {Priority::interactive, "a", 10, subscribers_});
  EXPECT_EQ(admission_.running(), 0);
  const Admission::Subscription sharing(admission_, subscribers_, "b");
  EXPECT_EQ(order(), (TurnOrder{"shared"}));
}

TEST_F(SharedWork, DropsDepartedSubscriber) {
  const Admission::Subscription first(admission_, subscribers_, "a");
  ask();
  std::optional<Admission::Subscription> second;
  second.emplace(admission_, subscribers_, "b");
  waiters_.add("b", demand("b"));
  second.reset();
  waiters_.add("b again", demand("b"));
  EXPECT_EQ(order(), (TurnOrder{"a1", "c", "a2", "b", "a3", "b again", "shared"}));
}

TEST_F(SharedWork, DropsDepartedFirstClient) {
  std::optional<Admission::Subscription> first;
  first.emplace(admission_, subscribers_, "a");
  waiters_.add("shared", {Priority::interactive, "a", 10, subscribers_});
  const Admission::Subscription second(admission_, subscribers_, "b");
  first.reset();
  waiters_.add("a", demand("a", 5));
  EXPECT_EQ(order(), (TurnOrder{"a", "shared"}));  // virtual finish times: 5 10, not 15 10
}

// Shared work that keeps its slot while another client waits for it.
class RunningSharedWork : public SharedWork {
 protected:
  RunningSharedWork() {
    ticket_.reset();
    ticket_.emplace(admission_.enter({Priority::interactive, "a", 1e9, subscribers_}, kNever));
  }
  void another_waits() {
    waiters_.add("z", demand("z"));
    timer_.advance(50ms);
    waiters_.join();
    timer_.advance(200ms);
  }
  // Ends the running work and returns the order in which `clients` are admitted.
  TurnOrder order_of(const std::vector<const char*>& clients) {
    ticket_.reset();
    ticket_.emplace(admission_.enter(demand("y"), kNever));
    for (const char* client : clients) waiters_.add(client, demand(client));
    return order();
  }

  std::optional<Admission::Subscription> first_{std::in_place, admission_, subscribers_, "a"};
};

TEST_F(RunningSharedWork, ChargesDepartedSubscriber) {
  const Admission::Subscription second(admission_, subscribers_, "b");
  another_waits();
  first_.reset();
  EXPECT_EQ(order_of({"a", "c"}), (TurnOrder{"z", "c", "a"}));
}

TEST_F(RunningSharedWork, ChargesLateSubscriberFromArrivalOnly) {
  another_waits();
  const Admission::Subscription late(admission_, subscribers_, "b");
  EXPECT_EQ(order_of({"a", "b", "c"}), (TurnOrder{"z", "b", "c", "a"}));
}

TEST_F(RunningSharedWork, ChargesRepeatedSubscriptions) {
  waiters_.add("z", demand("z"));
  for (int i = 0; i < 8; ++i) {
    const Admission::Subscription visit(admission_, subscribers_, "b");
    timer_.advance(40ms);
  }
  waiters_.join();  // z has the slot since 50 ms, and its thread must be first in the order
  EXPECT_EQ(order_of({"b", "c"}), (TurnOrder{"z", "c", "b"}));
}

TEST_F(RunningSharedWork, YieldsSlotToDepartedSubscriber) {
  std::optional<Admission::Subscription> second(std::in_place, admission_, subscribers_, "b");
  waiters_.add("b", demand("b"));
  timer_.advance(100ms);
  EXPECT_FALSE(ticket_->expired());  // b also subscribes to the running work
  second.reset();
  EXPECT_TRUE(ticket_->expired());
  waiters_.join();
}

TEST_F(SharedWork, PreemptsSlotOfSingleSubscriber) {
  const Admission::Subscription first(admission_, subscribers_, "z"), second(admission_, subscribers_, "b");
  waiters_.add("shared", {Priority::interactive, "z", 10, subscribers_});
  timer_.advance(50ms);
  EXPECT_TRUE(ticket_->expired());
  waiters_.join();
}

TEST_F(SharedWork, CountsPreemptionAgainstDepartedFirstClient) {
  ticket_.reset();
  const Admission::Subscription stays(admission_, subscribers_, "b");
  std::list<Admission::Ticket> lost;
  for (int i = 0; i < 2; ++i) {  // two preemptions per slot delay the client
    const Admission::Subscription leaves(admission_, subscribers_, "a");
    lost.push_back(admission_.enter({Priority::interactive, "a", 10, subscribers_}, kNever));
    timer_.advance(50ms);
    const auto other = admission_.enter(demand("c"), kNever);
  }
  waiters_.add("a", demand("a"));
  EXPECT_EQ(waiters_.order(), TurnOrder{});  // although the slot is free
  lost.clear();
  waiters_.join();
}

// Two clients request the same image. The first has much other work queued before it.
TEST_F(SharedWork, AdmitsSharedImageEarliest) {
  for (const char* name : {"a1", "a2"}) waiters_.add(name, demand("a"));
  waiters_.add("c", demand("c", 15));
  SubscribersByKey by_key;
  Pictures pictures(1 << 20);
  const auto get = [&](const std::string& client) {
    SlotRequest asked = demand(client);
    asked.subscribers = by_key.of("key");
    pictures.get("key", {kNever, client, asked.subscribers, &admission_}, [&](const std::stop_token& stop) {
      const auto ticket = admission_.enter(asked, stop);
      waiters_.note("picture");
      return Picture{.bytes = "x", .stats = {}};
    });
  };
  std::jthread first(get, "a");
  EXPECT_TRUE(test::eventually([&] { return admission_.waiting() == 4; }));
  std::jthread second(get, "b");
  EXPECT_TRUE(test::eventually([&] { return pictures.waiting("key") == 2; }));
  EXPECT_EQ(order(), (TurnOrder{"a1", "picture", "c", "a2"}));
}

}  // namespace
}  // namespace orrery
