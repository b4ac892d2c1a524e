#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <vector>

#include "server/scheduler/admission.h"
#include "tests/server/manual_timer.h"
#include "tests/server/waiters.h"

// Tests the Retry-After of rejected requests.
namespace orrery {
namespace {

using test::demand;
using test::kNever;
using test::Waiters;

// Returns the Retry-After, in seconds, from an admission with one slot while `waiting` rays are queued.
// Returns 0 if the request is admitted.
double retry_after(Admission& admission, double waiting) {
  Waiters waiters(admission);
  const auto ticket = admission.enter(demand("z"), kNever);
  waiters.add("a", demand("a", waiting));
  try {
    admission.enter(demand("b", waiting), kNever);
  } catch (const Busy& busy) {
    return busy.retry_after_s();
  }
  return 0;
}

struct Work {
  double expected, traced;  // rays
  double seconds;
};
// Returns the Retry-After, in seconds, while `waiting` rays are queued and after the work in `done` has run
// sequentially.
double retry_after(const std::vector<Work>& done, double waiting) {
  ManualTimer timer;
  Admission admission({.running = 1, .max_queued_rays = 1}, timer);
  for (const Work& work : done) {
    auto ticket = admission.enter(demand("z", work.expected), kNever);
    timer.advance(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(work.seconds)));
    ticket.set_cost(work.traced);
  }
  return retry_after(admission, waiting);
}

// Retry-After is the number of queued rays divided by the measured rate.
TEST(RetryAfter, DividesQueuedRaysByMeasuredRate) {
  EXPECT_DOUBLE_EQ(retry_after({{4e6, 4e6, 2}}, 10e6), 5);
  EXPECT_DOUBLE_EQ(retry_after({{4e6, 4e6, 2}}, 40e6), 20);
  EXPECT_DOUBLE_EQ(retry_after({{4e6, 4e6, 0.5}}, 40e6), 5);
}

TEST(RetryAfter, StaysBetweenOneAndThirtySeconds) {
  EXPECT_DOUBLE_EQ(retry_after({{4e6, 4e6, 2}}, 2.5e6), 1.25);
  EXPECT_EQ(retry_after({{4e6, 4e6, 2}}, 1.5e6), 1);
  EXPECT_DOUBLE_EQ(retry_after({{4e6, 4e6, 2}}, 58e6), 29);
  EXPECT_EQ(retry_after({{4e6, 4e6, 2}}, 62e6), 30);
}

TEST(RetryAfter, CountsTracedRatherThanEstimatedRays) {
  EXPECT_DOUBLE_EQ(retry_after({{40e6, 4e6, 2}}, 10e6), 5);
}

TEST(RetryAfter, DefaultsToFiveSecondsBeforeMeasurement) { EXPECT_DOUBLE_EQ(retry_after({}, 50e6), 5); }

// The weight of a measurement decays to 1/e over 10 s of work.
TEST(RetryAfter, FollowsChangingRate) {
  const double faded = std::exp(-1), rate = (1e6 * faded + 9e6) / (10 * faded + 10);
  EXPECT_DOUBLE_EQ(retry_after({{1e6, 1e6, 10}, {9e6, 9e6, 10}}, 5e6), 5e6 / rate);
}

TEST(RetryAfter, AddsConcurrentWorkAndIgnoresIdleTime) {
  ManualTimer timer;
  Admission two({.running = 2, .max_queued_rays = 1}, timer);
  {
    const auto a = two.enter(demand("a", 3e6), kNever), b = two.enter(demand("b", 1e6), kNever);
    timer.advance(std::chrono::seconds(1));
  }
  timer.advance(std::chrono::hours(1));
  const auto other = two.enter(demand("y"), kNever);
  EXPECT_DOUBLE_EQ(retry_after(two, 20e6), 5);
}

}  // namespace
}  // namespace orrery
