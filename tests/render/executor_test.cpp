#include "core/render/executor.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>

#include "core/base/task_scope.h"

namespace orrery {
namespace {

TEST(ThreadExecutor, RunsEveryStepOnceWithExclusiveWorker) {
  for (const int threads : {1, 3}) {
    ThreadExecutor executor(threads);
    EXPECT_EQ(executor.threads(), threads);
    std::mutex mutex;
    std::multiset<int> steps, busy;
    executor.for_each(200, [&](int step, int worker) {
      {
        const std::lock_guard lock(mutex);
        steps.insert(step);
        busy.insert(worker);
        EXPECT_EQ(busy.count(worker), 1u);
        EXPECT_LT(worker, threads);
      }
      const std::lock_guard lock(mutex);
      busy.erase(worker);
    });
    for (int step = 0; step < 200; ++step) EXPECT_EQ(steps.count(step), 1u);
    EXPECT_EQ(steps.size(), 200u);
  }
}

TEST(ThreadExecutor, EndsLoopAndRethrowsFailure) {
  ThreadExecutor executor(2);
  std::atomic<int> begun = 0;
  const auto fail = [&](int, int) {
    ++begun;
    throw std::runtime_error("a step failed");
  };
  EXPECT_THROW(executor.for_each(1000, fail), std::runtime_error);
  EXPECT_LE(begun, 2);
}

TEST(ThreadExecutor, PassesTaskScopeToSteps) {
  ThreadExecutor executor(2);
  const std::stop_source source;
  const std::stop_token stop = source.get_token();
  const TaskScope scope({nullptr, &stop});
  std::atomic<int> seen = 0;
  executor.for_each(8, [&](int, int) { seen += TaskScope::current().stop == &stop; });
  EXPECT_EQ(seen, 8);
}

}  // namespace
}  // namespace orrery
