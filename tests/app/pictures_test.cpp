#include "server/app/pictures.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "core/base/error.h"
#include "server/app/watch.h"

// What is made once for all who ask, and what is kept.
namespace orrery {
namespace {

const Pictures::Gone kStays = [] { return false; };

Picture picture(std::string bytes) { return {.bytes = std::move(bytes), .stats = {}}; }

TEST(Pictures, AreKeptUntilOthersNeedTheirRoom) {
  Pictures pictures(10'000);
  int made = 0;
  const auto get = [&](const std::string& key) {
    return pictures.get(key, kStays, [&](const auto&) {
      ++made;
      return picture(std::string(3000, key[0]));
    });
  };
  EXPECT_TRUE(get("a").made_here);
  EXPECT_FALSE(get("a").made_here);
  EXPECT_EQ(get("a").picture->bytes, std::string(3000, 'a'));
  EXPECT_EQ(made, 1);
  get("b");
  get("c");  // three take more than 10,000 bytes with their figures
  EXPECT_LE(pictures.bytes(), 10'000U);
  EXPECT_EQ(made, 3);
  EXPECT_TRUE(get("a").made_here);
}

TEST(Pictures, TooLargeToKeepAreMadeAllTheSame) {
  Pictures pictures(0);
  for (int i = 0; i < 2; ++i)
    EXPECT_TRUE(pictures.get("a", kStays, [](const auto&) { return picture("x"); }).made_here);
  EXPECT_EQ(pictures.bytes(), 0U);
}

TEST(Pictures, ThatManyAskForAtOnceAreMadeOnce) {
  Pictures pictures(1 << 20);
  std::atomic<int> made{0}, here{0}, waiting{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i)
    threads.emplace_back([&] {
      ++waiting;
      const auto found = pictures.get("a", kStays, [&](const auto&) {
        while (waiting < 8) std::this_thread::yield();
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        ++made;
        return picture("x");
      });
      here += found.made_here;
      EXPECT_EQ(found.picture->bytes, "x");
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(made, 1);
  EXPECT_EQ(here, 1);
}

// Has a second caller join the first while that makes the picture.
struct Pair {
  Pictures pictures{1 << 20};
  std::atomic<bool> making{false}, first_gone{false}, second_gone{false};
  std::atomic<int> asked_by_second{0};

  template <class First, class Second>
  void run(const First& first, const Second& second) {
    std::thread one([&] {
      first([&](const auto& make) {
        return pictures.get(
            "a", [&] { return bool(first_gone); },
            [&](const Pictures::Gone& gone) {
              making = true;
              while (asked_by_second == 0) std::this_thread::yield();
              return make(gone);
            });
      });
    });
    while (!making) std::this_thread::yield();
    second([&](const auto& make) {
      return pictures.get(
          "a",
          [&] {
            ++asked_by_second;
            return bool(second_gone);
          },
          make);
    });
    one.join();
  }
};

TEST(Pictures, AreFinishedForTheOthersWhenTheFirstLeaves) {
  Pair pair;
  pair.run(
      [&](const auto& get) {
        get([&](const Pictures::Gone& gone) {
          pair.first_gone = true;
          EXPECT_FALSE(gone());
          return picture("x");
        });
      },
      [&](const auto& get) {
        const auto found = get([](const auto&) { return picture("y"); });
        EXPECT_EQ(found.picture->bytes, "x");
      });
}

TEST(Pictures, AreGivenUpWhenAllHaveLeft) {
  Pair pair;
  pair.run(
      [&](const auto& get) {
        EXPECT_THROW(get([&](const Pictures::Gone& gone) -> Picture {
                       pair.first_gone = pair.second_gone = true;
                       while (!gone()) std::this_thread::yield();
                       throw Cancelled();
                     }),
                     Cancelled);
      },
      [&](const auto& get) { EXPECT_THROW(get([](const auto&) { return picture("y"); }), Cancelled); });
}

TEST(Pictures, RefusedToOneAreMadeByTheNext) {
  Pair pair;
  pair.run(
      [&](const auto& get) {
        EXPECT_THROW(get([&](const auto&) -> Picture { throw Busy("full", 1); }), Busy);
      },
      [&](const auto& get) {
        const auto found = get([](const auto&) { return picture("y"); });
        EXPECT_TRUE(found.made_here);
        EXPECT_EQ(found.picture->bytes, "y");
      });
}

TEST(Pictures, WhoseTimeIsUpForOneAreMadeByTheNext) {
  Pair pair;
  pair.run(
      [&](const auto& get) {
        EXPECT_THROW(get([&](const auto&) -> Picture { throw TimedOut("too long"); }), TimedOut);
      },
      [&](const auto& get) { EXPECT_TRUE(get([](const auto&) { return picture("y"); }).made_here); });
}

TEST(Pictures, ThatFailFailForAll) {
  Pair pair;
  const auto fails = [&](const auto& get) {
    EXPECT_THROW(get([](const auto&) -> Picture { throw Error("no"); }), Error);
  };
  pair.run(fails, fails);
}

}  // namespace
}  // namespace orrery
