#include "server/app/admission.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "tests/app/manual_timer.h"

// Who gets a turn, and who is turned away.
namespace orrery {
namespace {

using RenderOrder = std::vector<std::string>;

const std::stop_token kNever;

// People who wait for their turn, each on a thread, and the order in which they got it.
class Waiters {
 public:
  explicit Waiters(Admission& admission) : admission_(admission) {}
  ~Waiters() { join(); }

  // Returns once `name` waits, or was turned away.
  void add(const std::string& name, const Demand& demand) {
    const auto settled = [&] { return admission_.waiting() + order().size(); };
    const auto before = settled();
    threads_.emplace_back([this, name, demand] { wait(name, demand); });
    while (settled() == before) std::this_thread::yield();
  }
  void join() {
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
  }
  RenderOrder order() {
    const std::lock_guard lock(mutex_);
    return order_;
  }

 private:
  void wait(const std::string& name, const Demand& demand) {
    try {
      const auto ticket = admission_.enter(demand, kNever);
      note(name);
    } catch (const ClientBusy&) {
      note(name + " 429");
    } catch (const Busy&) {
      note(name + " 503");
    }
  }
  void note(const std::string& what) {
    const std::lock_guard lock(mutex_);
    order_.push_back(what);
  }

  Admission& admission_;
  std::vector<std::thread> threads_;
  std::mutex mutex_;
  RenderOrder order_;
};

Demand demand(const std::string& client, double cost = 10, Lane lane = Lane::interactive) {
  return {lane, client, cost};
}

TEST(Admission, ClientsShareByCostHoweverMuchEachAsksFor) {
  ManualTimer timer;
  Admission admission({.running = 1, .queue_rays = 1000}, timer);
  Waiters waiters(admission);
  {
    const auto ticket = admission.enter(demand("z"), kNever);
    for (const char* name : {"a1", "a2", "a3", "a4"}) waiters.add(name, demand("a"));
    for (const char* name : {"b1", "b2"}) waiters.add(name, demand("b", 15));
  }
  waiters.join();
  EXPECT_EQ(waiters.order(),
            (RenderOrder{"a1", "b1", "a2", "a3", "b2", "a4"}));  // finish at 10 15 20 30 30 40
}

TEST(Admission, InteractiveWorkGoesFirstButBatchWorkAlwaysHasAPlace) {
  ManualTimer timer;
  Admission admission({.running = 2, .queue_rays = 1000}, timer);
  Waiters waiters(admission);
  {
    const auto batch = admission.enter(demand("z", 10, Lane::batch), kNever);
    {
      const auto interactive = admission.enter(demand("z"), kNever);
      waiters.add("batch", demand("a", 10, Lane::batch));
      waiters.add("i1", demand("a"));
      waiters.add("i2", demand("a"));
    }
    while (waiters.order().size() < 2) std::this_thread::yield();
    EXPECT_EQ(admission.waiting(), 1);  // half of the places are batch work's, and that is one
    EXPECT_EQ(waiters.order(), (RenderOrder{"i1", "i2"}));
  }
  waiters.join();
  EXPECT_EQ(waiters.order(), (RenderOrder{"i1", "i2", "batch"}));

  const auto first = admission.enter(demand("z"), kNever);
  Waiters others(admission);
  {
    const auto second = admission.enter(demand("z"), kNever);
    others.add("i", demand("a"));
    others.add("batch", demand("a", 10, Lane::batch));
  }
  others.join();
  EXPECT_EQ(others.order(), (RenderOrder{"batch", "i"}));  // none of it ran
}

TEST(Admission, WhatWaitsIsBoundedByItsCost) {
  ManualTimer timer;
  Admission admission({.running = 1, .queue_rays = 100}, timer);
  Waiters waiters(admission);
  {
    const auto ticket = admission.enter(demand("z"), kNever);
    EXPECT_FALSE(admission.full());
    waiters.add("large", demand("a", 1e12));  // alone, it may wait
    EXPECT_TRUE(admission.full());
    EXPECT_THROW(admission.enter(demand("a", 1), kNever), Busy);
  }
  waiters.join();
  EXPECT_EQ(waiters.order(), (RenderOrder{"large"}));
  {
    const auto ticket = admission.enter(demand("z"), kNever);
    for (int i = 0; i < 10; ++i) waiters.add("small", demand("a", 10));
    waiters.add("one more", demand("a", 10));
  }
  waiters.join();
  EXPECT_EQ(waiters.order()[1], "one more 503");
  EXPECT_EQ(waiters.order().size(), 12U);
}

TEST(Admission, ALaneThatIsFullShutsNobodyOutOfTheOther) {
  ManualTimer timer;
  Admission admission({.running = 2, .queue_rays = 100}, timer);
  Waiters waiters(admission);
  {
    const auto batch = admission.enter(demand("z", 10, Lane::batch), kNever);
    waiters.add("b1", demand("a", 1e6, Lane::batch));
    EXPECT_FALSE(admission.full());
    const auto interactive = admission.enter(demand("a"), kNever);  // at once
    waiters.add("i1", demand("b"));
    EXPECT_EQ(waiters.order(), RenderOrder{});
  }
  waiters.join();
  EXPECT_EQ(waiters.order().size(), 2U);
}

TEST(Admission, OfOnePlaceBatchWorkHasEveryOtherTurn) {
  ManualTimer timer;
  Admission admission({.running = 1, .queue_rays = 1000}, timer);
  Waiters waiters(admission);
  {
    const auto ticket = admission.enter(demand("z"), kNever);
    for (const char* name : {"b1", "b2", "b3"}) waiters.add(name, demand("a", 10, Lane::batch));
    for (const char* name : {"i1", "i2"}) waiters.add(name, demand("b"));
  }
  waiters.join();
  EXPECT_EQ(waiters.order(), (RenderOrder{"b1", "i1", "b2", "i2", "b3"}));
}

TEST(Admission, WhoHasMostWaitingMakesRoom) {
  ManualTimer timer;
  Admission admission({.running = 1, .queue_rays = 100}, timer);
  Waiters waiters(admission);
  {
    const auto ticket = admission.enter(demand("z"), kNever);
    for (const char* name : {"a1", "a2", "a3"}) waiters.add(name, demand("a", 30));
    waiters.add("b1", demand("b", 30));
    while (waiters.order().empty()) std::this_thread::yield();
    EXPECT_EQ(waiters.order(), (RenderOrder{"a3 429"}));
    waiters.add("a4", demand("a", 30));  // now a has 60 and b 30
    EXPECT_EQ(waiters.order(), (RenderOrder{"a3 429", "a4 429"}));
    waiters.add("b2", demand("b", 30));  // which would not leave b with less than a
    EXPECT_EQ(waiters.order(), (RenderOrder{"a3 429", "a4 429", "b2 429"}));
  }
  waiters.join();
  EXPECT_EQ(waiters.order(), (RenderOrder{"a3 429", "a4 429", "b2 429", "a1", "b1", "a2"}));
}

TEST(Admission, WorkThatBeganIsNotTurnedAway) {
  ManualTimer timer;
  Admission admission({.running = 1, .queue_rays = 10}, timer);
  std::atomic<bool> done{false};
  std::thread again;
  {
    const auto ticket = admission.enter(demand("z"), kNever);
    again = std::thread([&] {
      const auto later = admission.enter_again(demand("a", 1000), kNever);
      done = true;
    });
    while (admission.waiting() == 0) std::this_thread::yield();
    EXPECT_FALSE(admission.full());  // nor does it keep others from waiting
  }
  again.join();
  EXPECT_TRUE(done);
}

TEST(Admission, WhoGivesUpLeavesTheQueue) {
  ManualTimer timer;
  Admission admission({.running = 1, .queue_rays = 100}, timer);
  const auto ticket = admission.enter(demand("z"), kNever);
  std::stop_source stop;
  std::thread waits([&] { EXPECT_THROW(admission.enter(demand("a"), stop.get_token()), Cancelled); });
  while (admission.waiting() == 0) std::this_thread::yield();
  stop.request_stop();
  waits.join();
  EXPECT_EQ(admission.waiting(), 0);
  EXPECT_EQ(admission.running(), 1);
}

// The time after which to come again is the cost that waits over the rate at which work was done.
TEST(Admission, RetryAfterFollowsTheRateMeasured) {
  const auto told = [](double cost_done) {
    ManualTimer timer;
    Admission admission({.running = 1, .queue_rays = 1000}, timer);
    {
      const auto ticket = admission.enter(demand("z", cost_done), kNever);
      timer.advance(std::chrono::milliseconds(50));
    }
    Waiters waiters(admission);
    const auto ticket = admission.enter(demand("z"), kNever);
    waiters.add("a", demand("a", 1e7));
    try {
      admission.enter(demand("b", 1e7), kNever);
    } catch (const Busy& busy) {
      return busy.retry_after_s();
    }
    return 0.0;
  };
  EXPECT_EQ(told(100), 30);
  EXPECT_EQ(told(1e9), 1);
}

}  // namespace
}  // namespace orrery
