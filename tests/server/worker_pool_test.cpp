#include "server/scheduler/worker_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <semaphore>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tests/support/eventually.h"

namespace orrery {
namespace {

constexpr bool kForeground = false;

// Calls checkpoint() until `done`, for at most a minute. Returns `done`.
bool give_way_until(const std::atomic<bool>& done) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!done && std::chrono::steady_clock::now() < end) checkpoint();
  return done;
}

TEST(WorkerPool, RunsEveryStepOnceWithExclusiveWorker) {
  WorkerPool pool(3);
  std::mutex mutex;
  std::multiset<int> steps, busy;
  pool.for_each(200, kForeground, [&](int step, int worker) {
    {
      const std::lock_guard lock(mutex);
      steps.insert(step);
      busy.insert(worker);
      EXPECT_EQ(busy.count(worker), 1u);
      EXPECT_LE(busy.size(), 3u);
      EXPECT_LT(worker, 3);
    }
    const std::lock_guard lock(mutex);
    busy.erase(worker);
  });
  for (int step = 0; step < 200; ++step) EXPECT_EQ(steps.count(step), 1u);
  EXPECT_EQ(steps.size(), 200u);
}

TEST(WorkerPool, RunsOtherLoopsWhileLongStepYields) {
  for (const int threads : {1, 2}) {
    WorkerPool pool(threads);
    std::atomic<int> begun = 0;
    std::atomic<bool> small_done = false, seen = true;
    std::thread large([&] {
      pool.for_each(threads, kForeground, [&](int, int) {
        ++begun;
        if (!give_way_until(small_done)) seen = false;
      });
    });
    while (begun < threads) std::this_thread::yield();  // all threads are busy
    pool.for_each(4, kForeground, [](int, int) {});
    small_done = true;
    large.join();
    EXPECT_TRUE(seen) << threads;
  }
}

// A step that does not yield keeps its thread until the step ends.
TEST(WorkerPool, RunsLoopsAndTasksDuringNonYieldingStep) {
  for (const int threads : {1, 2}) {
    WorkerPool pool(threads);
    std::atomic<int> begun = 0;
    std::atomic<bool> done = false;
    std::thread stubborn([&] {
      pool.for_each(2 * threads, kForeground, [&](int, int) {
        ++begun;
        EXPECT_TRUE(test::eventually([&] { return done.load(); }));
        checkpoint();  // continues although its thread was replaced
      });
    });
    while (begun < threads) std::this_thread::yield();  // all threads are busy
    std::atomic<bool> task_done = false;
    pool.enqueue(kForeground, [&] { task_done = true; });
    pool.for_each(4, kForeground, [](int, int) {});
    EXPECT_TRUE(test::eventually([&] { return task_done.load(); }));
    EXPECT_EQ(begun, threads);
    done = true;
    stubborn.join();
    EXPECT_EQ(begun, 2 * threads);
  }
}

TEST(WorkerPool, RunsLoopsDuringLongTask) {
  WorkerPool pool(1);
  std::atomic<bool> begun = false, done = false, seen = false;
  pool.enqueue(kForeground, [&] {
    begun = true;
    seen = test::eventually([&] { return done.load(); });
  });
  while (!begun) std::this_thread::yield();
  pool.for_each(3, kForeground, [](int, int) {});
  done = true;
  EXPECT_TRUE(test::eventually([&] { return seen.load(); }));
}

TEST(WorkerPool, ResumesYieldedStepsRoundRobin) {
  constexpr int kLoops = 6;
  WorkerPool pool(2);
  std::atomic<int> present = 0, running = 0;
  std::atomic<bool> all_present = false, seen = true;
  std::vector<std::thread> callers;
  for (int i = 0; i < kLoops; ++i)
    callers.emplace_back([&] {
      pool.for_each(2, kForeground, [&](int, int) {
        if (++present == 2 * kLoops) all_present = true;
        if (!give_way_until(all_present)) seen = false;
        EXPECT_LE(++running, 2);  // at most one step per thread, even after yields
        --running;
      });
    });
  for (std::thread& caller : callers) caller.join();
  EXPECT_TRUE(seen) << present;
}

// Lease that expires once. renew() blocks until the test releases `give_back`.
struct OneLease final : SlotLease {
  bool expired() const override { return !asked.exchange(true); }
  void renew() override {
    paused = true;
    give_back.acquire();
    if (fails) throw std::runtime_error("not renewed");
  }
  mutable std::atomic<bool> asked = false;
  std::atomic<bool> paused = false;
  std::binary_semaphore give_back{0};
  bool fails = false;
};

TEST(WorkerPool, RunsNoStepDuringLeaseRenewal) {
  WorkerPool pool(2);
  OneLease lease;
  std::atomic<std::uint64_t> progress = 0;
  std::atomic<bool> ends = false;
  std::thread caller([&] {
    pool.for_each(
        3, kForeground,
        [&](int, int) {
          while (!ends) ++progress, checkpoint();
        },
        &lease);
  });
  EXPECT_TRUE(test::eventually([&] { return lease.paused.load(); }));
  // Running steps yield at the end of their time slices. After that no step continues, although the pool is
  // idle.
  EXPECT_TRUE(test::eventually([&] {
    const std::uint64_t before = progress;
    pool.for_each(20, kForeground, [](int, int) {});
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return progress == before;
  }));
  const std::uint64_t before = progress;
  lease.give_back.release();
  EXPECT_TRUE(test::eventually([&] { return progress > before; }));
  ends = true;
  caller.join();
}

TEST(WorkerPool, EndsLoopIfLeaseRenewalFails) {
  WorkerPool pool(1);
  OneLease lease;
  lease.fails = true;
  lease.give_back.release();
  std::atomic<int> begun = 0;
  const auto work = [&](int, int) {
    ++begun;
    EXPECT_TRUE(give_way_until(lease.paused));
  };
  EXPECT_THROW(pool.for_each(100, kForeground, work, &lease), std::runtime_error);
  EXPECT_EQ(begun, 1);
}

TEST(WorkerPool, RunsTasksDuringLongStep) {
  WorkerPool pool(1);
  std::atomic<bool> done = false;
  bool seen = false;
  pool.for_each(1, kForeground, [&](int, int) {
    pool.enqueue(kForeground, [&] { done = true; });
    seen = give_way_until(done);
  });
  EXPECT_TRUE(seen);
}

TEST(WorkerPool, EndsLoopAndRethrowsFailure) {
  WorkerPool pool(2);
  std::atomic<int> begun = 0;
  const auto fail = [&](int, int) {
    ++begun;
    throw std::runtime_error("a step failed");
  };
  EXPECT_THROW(pool.for_each(1000, kForeground, fail), std::runtime_error);
  EXPECT_LE(begun, 2);
}

}  // namespace
}  // namespace orrery
