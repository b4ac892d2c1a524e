#include "server/scheduler/admission.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <list>
#include <optional>
#include <thread>
#include <vector>

#include "core/plan/cost.h"
#include "core/plan/plan.h"
#include "server/config/settings.h"
#include "tests/server/manual_timer.h"
#include "tests/server/waiters.h"
#include "tests/support/eventually.h"
#include "tests/support/pictures.h"

// Tests the order of admission, preemption and the rejection of requests.
namespace orrery {
namespace {

using test::demand;
using test::kNever;
using test::TurnOrder;
using test::Waiters;

TEST(Admission, SharesSlotsByCost) {
  ManualTimer timer;
  Admission admission({.running = 1, .max_queued_rays = 1000}, timer);
  Waiters waiters(admission);
  {
    const auto ticket = admission.enter(demand("z"), kNever);
    for (const char* name : {"a1", "a2", "a3", "a4"}) waiters.add(name, demand("a"));
    for (const char* name : {"b1", "b2"}) waiters.add(name, demand("b", 15));
  }
  waiters.join();
  // Virtual finish times: 10 15 20 30 30 40.
  EXPECT_EQ(waiters.order(), (TurnOrder{"a1", "b1", "a2", "a3", "b2", "a4"}));
}

TEST(Admission, PrefersInteractiveWorkButReservesBatchSlot) {
  ManualTimer timer;
  Admission admission({.running = 2, .max_queued_rays = 1000}, timer);
  Waiters waiters(admission);
  {
    const auto batch = admission.enter(demand("z", 10, Priority::batch), kNever);
    {
      const auto interactive = admission.enter(demand("z"), kNever);
      waiters.add("batch", demand("a", 10, Priority::batch));
      waiters.add("i1", demand("a"));
      waiters.add("i2", demand("a"));
    }
    EXPECT_TRUE(test::eventually([&] { return waiters.order().size() == 2; }));
    EXPECT_EQ(admission.waiting(), 1);  // batch work gets at most half of the slots
    EXPECT_EQ(waiters.order(), (TurnOrder{"i1", "i2"}));
  }
  waiters.join();
  EXPECT_EQ(waiters.order(), (TurnOrder{"i1", "i2", "batch"}));

  const auto first = admission.enter(demand("z"), kNever);
  Waiters others(admission);
  {
    const auto second = admission.enter(demand("z"), kNever);
    others.add("i", demand("a"));
    others.add("batch", demand("a", 10, Priority::batch));
  }
  others.join();
  EXPECT_EQ(others.order(), (TurnOrder{"batch", "i"}));  // no batch work is running
}

using std::chrono_literals::operator""ms;

TEST(Admission, PreemptsForOtherClientAfterTimeSlice) {
  ManualTimer timer;
  Admission admission({.running = 1, .max_queued_rays = 1000}, timer);
  Waiters waiters(admission);
  std::optional ticket(admission.enter(demand("z"), kNever));
  waiters.add("a1", demand("a"));
  timer.advance(49ms);
  EXPECT_FALSE(ticket->expired());
  ticket->renew();  // no effect before expiry
  EXPECT_EQ(waiters.order(), TurnOrder{});
  timer.advance(1ms);
  EXPECT_TRUE(ticket->expired());
  EXPECT_TRUE(test::eventually([&] { return waiters.order() == TurnOrder{"a1"}; }));
  waiters.join();
  EXPECT_EQ(admission.running(), 0);
  EXPECT_EQ(admission.waiting(), 1);  // the preempted ticket
  ticket->renew();
  EXPECT_FALSE(ticket->expired());
  EXPECT_EQ(admission.running(), 1);
  ticket.reset();
  EXPECT_EQ(admission.running(), 0);
}

TEST(Admission, PreemptsForSameClientAfterLongerTimeSlice) {
  ManualTimer timer;
  Admission admission({.running = 1, .max_queued_rays = 1000}, timer);
  Waiters waiters(admission);
  const auto ticket = admission.enter(demand("a"), kNever);
  waiters.add("a1", demand("a"));
  timer.advance(199ms);
  EXPECT_FALSE(ticket.expired());
  timer.advance(1ms);
  EXPECT_TRUE(ticket.expired());
  waiters.join();
  EXPECT_EQ(waiters.order(), TurnOrder{"a1"});
}

TEST(Admission, PreemptsLongestHeldSlotOnArrival) {
  ManualTimer timer;
  Admission admission({.running = 2, .max_queued_rays = 1000}, timer);
  std::optional older(admission.enter(demand("z"), kNever));
  timer.advance(1ms);
  std::optional newer(admission.enter(demand("z"), kNever));
  timer.advance(std::chrono::hours(1));
  EXPECT_FALSE(older->expired());  // no request is waiting
  {
    const auto brief = admission.enter(demand("a"), kNever);  // admitted at once
    EXPECT_TRUE(older->expired());
    EXPECT_FALSE(newer->expired());
    EXPECT_EQ(admission.running(), 2);
  }
  EXPECT_EQ(admission.running(), 1);
  older.reset();
  EXPECT_EQ(admission.running(), 1);
}

class CountingTimer final : public ManualTimer {
 public:
  Clock::time_point now() const override {
    ++asked;
    return ManualTimer::now();
  }
  mutable std::atomic<int> asked{0};
};

// Resumed work is ordered by the time that it has used. A ticket that used 60 ms is admitted before one that
// used 600 ms.
TEST(Admission, ChargesUsedTimeToResumedWork) {
  CountingTimer timer;
  Admission admission({.running = 1, .max_queued_rays = 1e9}, timer);
  std::optional<Admission::Ticket> last;
  std::list<Admission::Ticket> tickets;
  for (const auto held : {600ms, 60ms}) {
    last.reset();
    tickets.push_back(admission.enter(demand("z" + std::to_string(held.count())), kNever));
    timer.advance(held);
    last.emplace(admission.enter(demand("y"), kNever));
  }
  TurnOrder order;  // accessed only with the single slot held
  const auto renew = [&](Admission::Ticket& ticket, const char* name) {
    const int before = timer.asked;
    std::thread thread([&order, &ticket, name] {
      ticket.renew();
      order.push_back(name);
      const auto done = std::move(ticket);
    });
    EXPECT_TRUE(test::eventually([&] { return timer.asked > before; }));
    EXPECT_EQ(admission.waiting(), 2);  // waiting() blocks until renew() waits
    return thread;
  };
  std::thread first = renew(tickets.front(), "600 ms"), second = renew(tickets.back(), "60 ms");
  last.reset();
  first.join();
  second.join();
  EXPECT_EQ(order, (TurnOrder{"60 ms", "600 ms"}));
}

// Occupies a slot for `held` with work of the client "slow" while another client waits.
void occupy_slot_while_contended(Admission& admission, ManualTimer& timer, std::chrono::milliseconds held) {
  Waiters others(admission);
  {
    const auto ticket = admission.enter(demand("slow", 30'000), kNever);
    others.add("other", demand("other", 30'000));
    timer.advance(held);
  }
  others.join();
}

// The overrun is charged by time at a fixed rate, not by the measured rate of the slow work.
TEST(Admission, ChargesOverrunToClient) {
  ManualTimer timer;
  Admission admission({.running = 1, .max_queued_rays = 1e9}, timer);
  occupy_slot_while_contended(admission, timer, 1000ms);  // charged as 10 million rays
  Waiters waiters(admission);
  std::optional ticket(admission.enter(demand("z", 30'000), kNever));
  waiters.add("slow", demand("slow", 30'000));
  for (int i = 0; i < 3; ++i) waiters.add("quick", demand("quick", 100'000));
  ticket.reset();
  waiters.join();
  EXPECT_EQ(waiters.order(), (TurnOrder{"quick", "quick", "quick", "slow"}));
}

// A client that used the service alone for a minute has no debt to later clients.
TEST(Admission, ChargesNothingWithoutContention) {
  ManualTimer timer;
  Admission admission({.running = 1, .max_queued_rays = 1e9}, timer);
  {
    const auto ticket = admission.enter(demand("slow", 30'000), kNever);
    timer.advance(60'000ms);
  }
  Waiters waiters(admission);
  std::optional ticket(admission.enter(demand("z", 30'000), kNever));
  for (int i = 0; i < 3; ++i) waiters.add("quick", demand("quick", 100'000));
  waiters.add("slow", demand("slow", 30'000));
  ticket.reset();
  waiters.join();
  EXPECT_EQ(waiters.order(), (TurnOrder{"slow", "quick", "quick", "quick"}));
}

// The debt is limited, so that the client waits for seconds and not for minutes.
TEST(Admission, BoundsClientDebt) {
  ManualTimer timer;
  Admission admission({.running = 1, .max_queued_rays = 1e15}, timer);
  occupy_slot_while_contended(admission, timer, 60'000ms);  // 600 million rays, limited to 8 million
  Waiters waiters(admission);
  std::optional ticket(admission.enter(demand("z", 30'000), kNever));
  waiters.add("slow", demand("slow", 30'000));
  for (int i = 0; i < 20; ++i) waiters.add("quick", demand("quick", 1e9));  // one slice each: 0.52 million
  ticket.reset();
  waiters.join();
  const TurnOrder order = waiters.order();
  const auto before = std::find(order.begin(), order.end(), "slow") - order.begin();
  EXPECT_GE(before, 14);
  EXPECT_LE(before, 17);
}

// Long work is first charged for one time slice of 50 ms, so that it need not wait for all shorter work.
TEST(Admission, ChargesLongWorkForFirstSliceOnly) {
  ManualTimer timer;
  Admission admission({.running = 1, .max_queued_rays = 1e15}, timer);
  Waiters waiters(admission);
  {
    const auto ticket = admission.enter(demand("z"), kNever);
    for (int i = 0; i < 2; ++i) waiters.add("small", demand("a", 400'000));
    waiters.add("long", demand("b", 1e12));
  }
  waiters.join();
  // Virtual finish times: 0.4, 0.52, 0.8 million.
  EXPECT_EQ(waiters.order(), (TurnOrder{"small", "long", "small"}));
}

TEST(Admission, PreemptsBatchRatherThanInteractiveWork) {
  ManualTimer timer;
  Admission admission({.running = 2, .max_queued_rays = 1000}, timer);
  const auto batch = admission.enter(demand("z", 10, Priority::batch), kNever);
  const auto interactive = admission.enter(demand("z"), kNever);
  Waiters waiters(admission);
  waiters.add("batch", demand("b", 10, Priority::batch));
  timer.advance(50ms);
  EXPECT_TRUE(batch.expired());
  EXPECT_FALSE(interactive.expired());  // batch work gets at most half of the slots
  waiters.join();
  timer.advance(50ms);
  const auto other = admission.enter(demand("c"), kNever);
  EXPECT_FALSE(interactive.expired());  // a slot is free
}

TEST(Admission, PreemptsInteractiveWorkIfNoBatchWorkRuns) {
  ManualTimer timer;
  Admission admission({.running = 1, .max_queued_rays = 1000}, timer);
  const auto interactive = admission.enter(demand("z"), kNever);
  timer.advance(50ms);
  const auto batch = admission.enter(demand("b", 10, Priority::batch), kNever);
  EXPECT_TRUE(interactive.expired());
  timer.advance(50ms);
  const auto other = admission.enter(demand("c"), kNever);
  EXPECT_TRUE(batch.expired());
}

TEST(Admission, DelaysClientsWithManyPreemptions) {
  ManualTimer timer;
  Admission admission({.running = 1, .max_queued_rays = 1000}, timer);
  std::list<Admission::Ticket> own;
  for (int i = 0; i < 2; ++i) {  // two preemptions per slot delay the client
    own.push_back(admission.enter(demand("z"), kNever));
    timer.advance(50ms);
    const auto other = admission.enter(demand("a"), kNever);
    EXPECT_TRUE(own.back().expired());
  }
  Waiters waiters(admission);
  waiters.add("z", demand("z"));
  EXPECT_EQ(admission.running(), 0);  // although the slot is free
  { const auto batch = admission.enter(demand("z", 10, Priority::batch), kNever); }
  EXPECT_EQ(waiters.order(), TurnOrder{});
  own.pop_front();
  waiters.join();
  EXPECT_EQ(waiters.order(), TurnOrder{"z"});
}

// Preempted work cannot be rejected, and its remaining cost does not fill the queue.
TEST(Admission, QueuesOthersDespiteLargePreemptedWork) {
  ManualTimer timer;
  Admission admission({.running = 1, .max_queued_rays = 1000}, timer);
  std::optional large(admission.enter(demand("z", 1e12), kNever));
  timer.advance(50ms);
  std::optional other(admission.enter(demand("a"), kNever));
  std::thread renewal([&] { large->renew(); });
  EXPECT_TRUE(test::eventually([&] { return admission.waiting() == 1; }));
  Waiters waiters(admission);
  waiters.add("b", demand("b", 5000));
  EXPECT_EQ(waiters.order(), TurnOrder{});
  EXPECT_THROW(admission.enter(demand("z", 1), kNever), LimitExceeded);
  other.reset();
  waiters.join();
  EXPECT_EQ(waiters.order(), TurnOrder{"b"});
  renewal.join();
}

TEST(Admission, ReportsShortestClientWait) {
  ManualTimer timer;
  Admission admission({.running = 1, .max_queued_rays = 1000}, timer);
  EXPECT_EQ(admission.shortest_client_wait(), Clock::duration{});
  Waiters waiters(admission);
  {
    const auto ticket = admission.enter(demand("z"), kNever);
    waiters.add("a", demand("a"));
    timer.advance(10ms);
    waiters.add("b1", demand("b"));
    waiters.add("batch", demand("c", 10, Priority::batch));
    timer.advance(20ms);
    waiters.add("b2", demand("b"));
    EXPECT_EQ(admission.shortest_client_wait(), 20ms);
  }
  waiters.join();
}

TEST(Admission, OccupiesNoSlotAfterCancelledRenewal) {
  ManualTimer timer;
  Admission admission({.running = 1, .max_queued_rays = 1000}, timer);
  std::stop_source stop;
  std::optional first(admission.enter(demand("z"), stop.get_token()));
  timer.advance(50ms);
  std::optional second(admission.enter(demand("a"), kNever));
  std::thread renewal([&] { EXPECT_THROW(first->renew(), Cancelled); });
  EXPECT_TRUE(test::eventually([&] { return admission.waiting() == 1; }));
  stop.request_stop();
  renewal.join();
  first.reset();
  EXPECT_EQ(admission.running(), 1);
  second.reset();
  EXPECT_EQ(admission.running(), 0);
}

TEST(Admission, BoundsQueueByCost) {
  ManualTimer timer;
  Admission admission({.running = 1, .max_queued_rays = 100}, timer);
  Waiters waiters(admission);
  {
    const auto ticket = admission.enter(demand("z"), kNever);
    EXPECT_FALSE(admission.full());
    waiters.add("large", demand("a", 1e12));  // a client's only work may exceed the limit
    EXPECT_FALSE(admission.full());           // the queue is not full for other clients
    EXPECT_THROW(admission.enter(demand("a", 1), kNever), Busy);
  }
  waiters.join();
  EXPECT_EQ(waiters.order(), (TurnOrder{"large"}));
  {
    const auto ticket = admission.enter(demand("z"), kNever);
    for (int i = 0; i < 10; ++i) waiters.add("small", demand("a", 10));
    waiters.add("one more", demand("a", 10));
    EXPECT_TRUE(admission.full());
  }
  waiters.join();
  EXPECT_EQ(waiters.order()[1], "one more 503");
  EXPECT_EQ(waiters.order().size(), 12U);
}

TEST(Admission, BoundsQueueOfEachPrioritySeparately) {
  ManualTimer timer;
  Admission admission({.running = 2, .max_queued_rays = 100}, timer);
  Waiters waiters(admission);
  {
    const auto batch = admission.enter(demand("z", 10, Priority::batch), kNever);
    waiters.add("b1", demand("a", 1e6, Priority::batch));
    EXPECT_FALSE(admission.full());
    const auto interactive = admission.enter(demand("a"), kNever);  // admitted at once
    waiters.add("i1", demand("b"));
    EXPECT_EQ(waiters.order(), TurnOrder{});
  }
  waiters.join();
  EXPECT_EQ(waiters.order().size(), 2U);
}

TEST(Admission, AlternatesPrioritiesOnSingleSlot) {
  ManualTimer timer;
  Admission admission({.running = 1, .max_queued_rays = 1000}, timer);
  Waiters waiters(admission);
  {
    const auto ticket = admission.enter(demand("z"), kNever);
    for (const char* name : {"b1", "b2", "b3"}) waiters.add(name, demand("a", 10, Priority::batch));
    for (const char* name : {"i1", "i2"}) waiters.add(name, demand("b"));
  }
  waiters.join();
  EXPECT_EQ(waiters.order(), (TurnOrder{"b1", "i1", "b2", "i2", "b3"}));
}

// Work that starts after a long delay has an old virtual finish time. New work must not overtake waiting
// clients because of it.
TEST(Admission, KeepsVirtualTimeMonotonic) {
  ManualTimer timer;
  Admission admission({.running = 1, .max_queued_rays = 1e9}, timer);
  Waiters waiters(admission);
  std::list<Admission::Ticket> lost;
  for (int i = 0; i < 2; ++i) {
    lost.push_back(admission.enter(demand("x"), kNever));
    timer.advance(50ms);
    const auto other = admission.enter(demand("y"), kNever);
  }
  std::optional<Admission::Ticket> old_ticket;
  // Client x was preempted too often.
  std::thread old([&] { old_ticket.emplace(admission.enter(demand("x"), kNever)); });
  EXPECT_TRUE(test::eventually([&] { return admission.waiting() == 3; }));
  for (int i = 0; i < 10; ++i) const auto work = admission.enter(demand("y", 1000), kNever);
  std::optional ticket(admission.enter(demand("y", 1000), kNever));
  waiters.add("v", demand("v"));
  lost.pop_front();
  ticket.reset();  // the delayed work starts
  old.join();
  waiters.add("z", demand("z", 1000));
  old_ticket.reset();
  waiters.join();
  EXPECT_EQ(waiters.order(), (TurnOrder{"v", "z"}));
}

TEST(Admission, DropsWorkOfClientWithLargestBacklog) {
  ManualTimer timer;
  Admission admission({.running = 1, .max_queued_rays = 100}, timer);
  Waiters waiters(admission);
  {
    const auto ticket = admission.enter(demand("z"), kNever);
    for (const char* name : {"a1", "a2", "a3"}) waiters.add(name, demand("a", 30));
    waiters.add("b1", demand("b", 30));
    EXPECT_TRUE(test::eventually([&] { return !waiters.order().empty(); }));
    EXPECT_EQ(waiters.order(), (TurnOrder{"a3 429"}));
    waiters.add("a4", demand("a", 30));  // queued: 60 of a, 30 of b
    EXPECT_EQ(waiters.order(), (TurnOrder{"a3 429", "a4 429"}));
    waiters.add("b2", demand("b", 30));  // b would then not have less queued than a
    EXPECT_EQ(waiters.order(), (TurnOrder{"a3 429", "a4 429", "b2 429"}));
  }
  waiters.join();
  EXPECT_EQ(waiters.order(), (TurnOrder{"a3 429", "a4 429", "b2 429", "a1", "b1", "a2"}));
}

TEST(Admission, NeverRejectsReenteredWork) {
  ManualTimer timer;
  Admission admission({.running = 1, .max_queued_rays = 10}, timer);
  std::atomic<bool> done{false};
  std::thread again;
  {
    const auto ticket = admission.enter(demand("z"), kNever);
    again = std::thread([&] {
      const auto later = admission.enter_again(demand("a", 1000), kNever);
      done = true;
    });
    EXPECT_TRUE(test::eventually([&] { return admission.waiting() == 1; }));
    EXPECT_FALSE(admission.full());  // re-entered work does not fill the queue
  }
  again.join();
  EXPECT_TRUE(done);
}

TEST(Admission, RemovesCancelledWorkFromQueue) {
  ManualTimer timer;
  Admission admission({.running = 1, .max_queued_rays = 100}, timer);
  const auto ticket = admission.enter(demand("z"), kNever);
  std::stop_source stop;
  std::thread waits([&] { EXPECT_THROW(admission.enter(demand("a"), stop.get_token()), Cancelled); });
  EXPECT_TRUE(test::eventually([&] { return admission.waiting() == 1; }));
  stop.request_stop();
  waits.join();
  EXPECT_EQ(admission.waiting(), 0);
  EXPECT_EQ(admission.running(), 1);
}

// The default queue accepts 20 images of several samples at once: one rendering, 19 queued. No throughput has
// been measured before.
TEST(Admission, QueuesTwentyImagesByDefault) {
  for (const char* name :
       {"paper", "orrery", "sphereflake-3", "mirrors", "material-reflective", "light-spot"}) {
    ManualTimer timer;
    Admission admission({.running = 1, .max_queued_rays = Settings{}.max_queued_rays}, timer);
    const auto scene = test::load(test::sample(name));
    RenderRequest request = test::size(800, 600);
    request.samples = 4;
    const double cost = kFixedCost + expected_rays(*scene, make_plan(*scene, request));
    Waiters waiters(admission);
    {
      const auto ticket = admission.enter(demand("z", cost), kNever);
      for (int i = 1; i < 20; ++i) waiters.add(name, demand("z", cost));
      EXPECT_EQ(waiters.order(), TurnOrder{}) << name;
    }
  }
}

}  // namespace
}  // namespace orrery
