#include "server/base/timer.h"

#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <string>

#include "tests/server/manual_timer.h"

// Tests that alarms fire on time and in order.
namespace orrery {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(Timer, FiresAlarmsOnTimeAndInOrder) {
  ManualTimer timer;
  const auto start = timer.now();
  std::string done;
  const auto note = [&](const char* what) {
    return [&done, &timer, start, what] {
      done += what + std::to_string((timer.now() - start) / seconds(1)) + " ";
    };
  };
  const auto c = timer.at(start + seconds(3), note("c")), a = timer.at(start + seconds(1), note("a")),
             b = timer.at(start + seconds(1), note("b"));
  timer.advance(seconds(1) - Clock::duration(1));
  EXPECT_EQ(done, "");
  timer.advance(Clock::duration(1));
  EXPECT_EQ(done, "a1 b1 ");
  timer.advance(seconds(10));
  EXPECT_EQ(done, "a1 b1 c3 ");
  EXPECT_EQ(timer.now() - start, seconds(11));
}

TEST(Timer, FiresOverdueAlarmAtOnce) {
  ManualTimer timer;
  int done = 0;
  const auto alarm = timer.at(timer.now(), [&] { ++done; });
  EXPECT_EQ(done, 1);
  timer.advance(seconds(1));
  EXPECT_EQ(done, 1);
}

TEST(Timer, DoesNotFireCancelledAlarm) {
  ManualTimer timer;
  int done = 0;
  {
    const auto alarm = timer.at(timer.now() + seconds(1), [&] { ++done; });
  }
  timer.advance(seconds(2));
  EXPECT_EQ(done, 0);
}

TEST(Timer, WaitsForRunningActionOnCancel) {
  ManualTimer timer;
  std::promise<void> begun, go_on;
  std::atomic<bool> ended{false};
  std::unique_ptr<Timer::Alarm> alarm;
  alarm.reset(new Timer::Alarm(timer.at(timer.now() + seconds(1), [&] {
    begun.set_value();
    go_on.get_future().wait();
    ended = true;
  })));
  std::thread driver([&] { timer.advance(seconds(1)); });
  begun.get_future().wait();
  auto called_off = std::async(std::launch::async, [&] {
    alarm.reset();
    return ended.load();
  });
  EXPECT_EQ(called_off.wait_for(milliseconds(20)), std::future_status::timeout);
  go_on.set_value();
  EXPECT_TRUE(called_off.get());
  driver.join();
}

TEST(Timer, AllowsActionToCancelItself) {
  ManualTimer timer;
  std::unique_ptr<Timer::Alarm> alarm;
  alarm.reset(new Timer::Alarm(timer.at(timer.now() + seconds(1), [&] { alarm.reset(); })));
  timer.advance(seconds(1));
  EXPECT_FALSE(alarm);
}

TEST(Timer, FiresInOrderOnSteadyClock) {
  SteadyTimer timer;
  std::promise<void> all;
  std::string done;
  const auto start = timer.now();
  const auto later = timer.at(start + milliseconds(30), [&] {
    done += timer.now() >= start + milliseconds(30) ? "later" : "early";
    all.set_value();
  });
  const auto sooner = timer.at(start + milliseconds(10), [&] { done += "sooner "; });
  all.get_future().wait();
  EXPECT_EQ(done, "sooner later");
}

// Thread that waits with a deadline.
struct Waiter {
  ManualTimer timer;
  std::mutex mutex;
  std::condition_variable_any changed;
  std::stop_source stop;
  bool ready = false;
  std::future<bool> got;
  const Clock::time_point deadline = timer.now() + seconds(5);

  void wait() {
    got = std::async(std::launch::async, [this] {
      std::unique_lock lock(mutex);
      return wait_until(timer, changed, lock, stop.get_token(), deadline, [this] { return ready; });
    });
    timer.await_alarm_by(deadline);
  }
};

TEST(WaitUntil, EndsAtDeadline) {
  Waiter waiter;
  waiter.wait();
  waiter.timer.advance(seconds(5) - Clock::duration(1));
  EXPECT_EQ(waiter.got.wait_for(milliseconds(20)), std::future_status::timeout);
  waiter.timer.advance(Clock::duration(1));
  EXPECT_FALSE(waiter.got.get());
}

TEST(WaitUntil, EndsWhenReady) {
  Waiter waiter;
  waiter.wait();
  {
    const std::lock_guard lock(waiter.mutex);
    waiter.ready = true;
  }
  waiter.changed.notify_all();
  EXPECT_TRUE(waiter.got.get());
}

TEST(WaitUntil, EndsWhenStopped) {
  Waiter waiter;
  waiter.wait();
  waiter.stop.request_stop();
  EXPECT_FALSE(waiter.got.get());
}

}  // namespace
}  // namespace orrery
