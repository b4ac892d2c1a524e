#include "server/app/watch.h"

#include <gtest/gtest.h>

// When work ends early, and for what reason.
namespace orrery {
namespace {

const std::atomic<bool> kGoesOn{false};

TEST(Watch, WhoHasLeftDoesNotComeBack) {
  bool gone = true;
  const Watch watch([&] { return gone; }, kGoesOn, std::chrono::seconds(60), "request_seconds");
  EXPECT_TRUE(watch.stop());
  gone = false;  // another came to wait for the same
  EXPECT_TRUE(watch.stop());
  EXPECT_THROW(watch.explain(), Cancelled);
}

TEST(Watch, TimeCountsFromTheRequest) {
  const auto stays = [] { return false; };
  const Watch watch(stays, kGoesOn, std::chrono::seconds(60), "request_seconds",
                    Clock::now() - std::chrono::seconds(61));
  EXPECT_TRUE(watch.stop());
  EXPECT_THROW(watch.explain(), TimedOut);
}

TEST(Watch, TheClientIsAskedNowAndThen) {
  int asked = 0;
  const auto stays = [&] {
    ++asked;
    return false;
  };
  const Watch watch(stays, kGoesOn, std::chrono::seconds(60), "request_seconds");
  const auto start = Clock::now();
  int looks = 0;
  for (; asked < 3; ++looks) EXPECT_FALSE(watch.stop());
  EXPECT_GT(looks, asked);
  EXPECT_GE(Clock::now() - start, std::chrono::milliseconds(10));  // twice the time between
}

}  // namespace
}  // namespace orrery
