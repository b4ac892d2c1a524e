#include "server/scheduler/watch.h"

#include <gtest/gtest.h>

#include "tests/server/manual_timer.h"

// Tests cancellation of work and the reported cause.
namespace orrery {
namespace {

using std::chrono::seconds;

struct WatchFixture {
  ManualTimer timer;
  std::stop_source gone, service_ends;
  Clock::duration age{};  // time since the request
  const WorkCancellation& watch() {
    made.emplace(gone.get_token(), service_ends.get_token(), timer, timer.now() - age,
                 WorkCancellation::Limit{seconds(60), "request_seconds"});
    return *made;
  }
  std::optional<WorkCancellation> made;
};

TEST(WorkCancellation, StopsWhenClientDisconnects) {
  WatchFixture w;
  const WorkCancellation& watch = w.watch();
  EXPECT_FALSE(watch.stop().stop_requested());
  w.gone.request_stop();
  EXPECT_TRUE(watch.stop().stop_requested());
  EXPECT_THROW(watch.explain(), Cancelled);
}

TEST(WorkCancellation, StopsWhenServiceEnds) {
  WatchFixture w;
  const WorkCancellation& watch = w.watch();
  w.service_ends.request_stop();
  EXPECT_TRUE(watch.stop().stop_requested());
  EXPECT_THROW(watch.explain(), Busy);
}

TEST(WorkCancellation, StopsAtDeadlineCountedFromRequest) {
  WatchFixture w;
  w.age = seconds(20);
  const WorkCancellation& watch = w.watch();
  w.timer.advance(seconds(40) - Clock::duration(1));
  EXPECT_FALSE(watch.stop().stop_requested());
  w.timer.advance(Clock::duration(1));
  EXPECT_TRUE(watch.stop().stop_requested());
  try {
    watch.explain();
  } catch (const TimedOut& error) {
    EXPECT_STREQ(error.what(),
                 "request took too long (limit 60 s, request_seconds); use fewer pixels or samples");
  }
}

TEST(WorkCancellation, StopsOverdueRequestAtOnce) {
  WatchFixture w;
  w.age = seconds(61);
  const WorkCancellation& watch = w.watch();
  EXPECT_TRUE(watch.stop().stop_requested());
  EXPECT_THROW(watch.explain(), TimedOut);
}

TEST(WorkCancellation, ReportsFirstCause) {
  WatchFixture w;
  const WorkCancellation& watch = w.watch();
  w.timer.advance(seconds(60));
  w.gone.request_stop();
  w.service_ends.request_stop();
  EXPECT_THROW(watch.explain(), TimedOut);
}

}  // namespace
}  // namespace orrery
