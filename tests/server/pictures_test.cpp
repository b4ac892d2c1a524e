#include "server/cache/pictures.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <thread>
#include <vector>

#include "core/base/error.h"
#include "server/scheduler/watch.h"

// Tests the image cache, and requests that share one image.
namespace orrery {
namespace {

const std::stop_token kNotCancelled;

Picture picture(std::string bytes) { return {.bytes = std::move(bytes), .stats = {}, .certificate = {}}; }

TEST(Pictures, CachesUntilSpaceIsNeeded) {
  const std::size_t most = 5 * held_bytes(picture(std::string(3000, 'a'))) / 2;
  Pictures pictures(most);
  int made = 0;
  const auto get = [&](const std::string& key) {
    return pictures.get(key, {kNotCancelled}, [&](const auto&) {
      ++made;
      return picture(std::string(3000, key[0]));
    });
  };
  EXPECT_TRUE(get("a").made_here);
  EXPECT_FALSE(get("a").made_here);
  EXPECT_EQ(get("a").value->bytes, std::string(3000, 'a'));
  EXPECT_EQ(made, 1);
  get("b");
  get("c");  // three images and their statistics exceed the limit
  EXPECT_LE(pictures.bytes(), most);
  EXPECT_EQ(made, 3);
  EXPECT_TRUE(get("a").made_here);
}

// A cache of many small images must not hold more memory than it counts.
TEST(Pictures, CountsStatisticsAndTexts) {
  Picture small = picture("x");
  small.bytes.shrink_to_fit();
  const std::size_t bare = held_bytes(small);
  EXPECT_GE(bare, sizeof(Picture) + 1024);
  small.warnings.push_back({"/objects/0", std::string(1000, 'x')});
  small.certificate.terms.push_back({"samples", Bound::unknown(), std::string(1000, 'x')});
  EXPECT_GE(held_bytes(small), bare + 2000);
  const RenderResult film{Film(1, 1, FilmStorage::srgb8, {}), {}};
  EXPECT_GE(held_bytes(film), sizeof(RenderResult) + 1024);
}

TEST(Pictures, KeepsImagesOfOtherClientsDuringFlood) {
  Pictures pictures(50'000);
  const auto get = [&](const std::string& key, const std::string& client) {
    return pictures.get(key, {kNotCancelled, client},
                        [&](const auto&) { return picture(std::string(3000, 'x')); });
  };
  EXPECT_TRUE(get("a", "one").made_here);
  for (int i = 0; i < 100; ++i) get(std::to_string(i), "flood");
  EXPECT_FALSE(get("a", "one").made_here);
  EXPECT_FALSE(get("99", "flood").made_here);
  EXPECT_GT(pictures.evictions(), 80U);
}

TEST(Pictures, ReturnsImagesTooLargeToCache) {
  Pictures pictures(0);
  for (int i = 0; i < 2; ++i)
    EXPECT_TRUE(pictures.get("a", {kNotCancelled}, [](const auto&) { return picture("x"); }).made_here);
  EXPECT_EQ(pictures.bytes(), 0U);
}

TEST(Pictures, RendersConcurrentlyRequestedImageOnce) {
  Pictures pictures(1 << 20);
  std::atomic<int> made{0}, here{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i)
    threads.emplace_back([&] {
      const auto found = pictures.get("a", {kNotCancelled}, [&](const auto&) {
        while (pictures.waiting("a") < 8) std::this_thread::yield();
        ++made;
        return picture("x");
      });
      here += found.made_here;
      EXPECT_EQ(found.value->bytes, "x");
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(made, 1);
  EXPECT_EQ(here, 1);
}

// Runs two callers that request the same image. The second joins while the first makes the image.
struct Pair {
  Pictures pictures{1 << 20};
  std::stop_source first_gone, second_gone;

  // Calls each of `first` and `second` with a function get(make) that returns the image and calls `make` to
  // produce it.
  template <class First, class Second>
  void run(const First& first, const Second& second) {
    std::promise<void> making, joined;
    std::thread one([&] {
      first([&](const Pictures::Make& make) {
        return pictures.get("a", {first_gone.get_token()}, [&](const std::stop_token& stop) {
          making.set_value();
          joined.get_future().wait();
          return make(stop);
        });
      });
    });
    making.get_future().wait();
    std::thread two([&] {
      second([&](const Pictures::Make& make) { return pictures.get("a", {second_gone.get_token()}, make); });
    });
    while (pictures.waiting("a") < 2) std::this_thread::yield();
    joined.set_value();
    one.join();
    two.join();
  }
};

TEST(Pictures, FinishesForOtherClientsWhenFirstDisconnects) {
  Pair pair;
  pair.run(
      [&](const auto& get) {
        get([&](const std::stop_token& stop) {
          pair.first_gone.request_stop();
          EXPECT_FALSE(stop.stop_requested());
          return picture("x");
        });
      },
      [&](const auto& get) {
        const auto found = get([](const auto&) { return picture("y"); });
        EXPECT_EQ(found.value->bytes, "x");
      });
}

TEST(Pictures, CancelsWhenAllRequestersDisconnect) {
  Pair pair;
  pair.run(
      [&](const auto& get) {
        EXPECT_THROW(get([&](const std::stop_token& stop) -> Picture {
                       pair.first_gone.request_stop();
                       pair.second_gone.request_stop();
                       EXPECT_TRUE(stop.stop_requested());
                       throw Cancelled();
                     }),
                     Cancelled);
      },
      [&](const auto& get) { EXPECT_THROW(get([](const auto&) { return picture("y"); }), Cancelled); });
}

TEST(Pictures, RetriesForNextRequesterAfterRejection) {
  Pair pair;
  pair.run(
      [&](const auto& get) {
        EXPECT_THROW(get([&](const auto&) -> Picture { throw Busy("full", 1); }), Busy);
      },
      [&](const auto& get) {
        const auto found = get([](const auto&) { return picture("y"); });
        EXPECT_TRUE(found.made_here);
        EXPECT_EQ(found.value->bytes, "y");
      });
}

TEST(Pictures, RetriesForNextRequesterAfterTimeout) {
  Pair pair;
  pair.run(
      [&](const auto& get) {
        EXPECT_THROW(get([&](const auto&) -> Picture { throw TimedOut("too long"); }), TimedOut);
      },
      [&](const auto& get) { EXPECT_TRUE(get([](const auto&) { return picture("y"); }).made_here); });
}

TEST(Pictures, ReportsFailureToAllRequesters) {
  Pair pair;
  const auto fails = [&](const auto& get) {
    EXPECT_THROW(get([](const auto&) -> Picture { throw Error("no"); }), Error);
  };
  pair.run(fails, fails);
}

}  // namespace
}  // namespace orrery
