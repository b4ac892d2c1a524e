#include "core/render/executor.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>

#include "core/base/parallel.h"

namespace orrery {

struct ThreadExecutor::Threads {
  explicit Threads(int threads)
      : count(threads),
        limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)),
        arena(threads) {}
  const int count;
  const tbb::global_control limit;
  tbb::task_arena arena;
};

ThreadExecutor::ThreadExecutor(int threads)
    : threads_(std::make_unique<Threads>(threads > 0 ? threads : tbb::info::default_concurrency())) {}
ThreadExecutor::~ThreadExecutor() = default;

int ThreadExecutor::threads() const { return threads_->count; }

void ThreadExecutor::for_each(int count, const Step& work) {
  const TaskContext context = TaskScope::current();
  TsanFence to_workers, from_workers;
  std::atomic<int> next{0};
  std::mutex mutex;
  std::exception_ptr error;  // guarded by `mutex`
  const auto run_steps = [&](int worker) {
    const TaskScope scope(context);
    try {
      for (int step; (step = next++) < count;) work(step, worker);
    } catch (...) {
      next = count;
      const std::lock_guard lock(mutex);
      if (!error) error = std::current_exception();
    }
  };
  to_workers.release();
  threads_->arena.execute([&]() ORRERY_UNSEEN {  // may run on a thread of the arena
    tbb::parallel_for(
        tbb::blocked_range<int>(0, std::min(count, threads_->count)),
        [&](const tbb::blocked_range<int>& workers) ORRERY_UNSEEN {
          to_workers.acquire();
          for (int worker = workers.begin(); worker != workers.end(); ++worker) run_steps(worker);
          from_workers.release();
        },
        tbb::simple_partitioner());
  });
  from_workers.acquire();
  if (error) std::rethrow_exception(error);
}

}  // namespace orrery
