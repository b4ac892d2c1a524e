#pragma once

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/parallel_sort.h>

#include "core/base/task_scope.h"

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>

#include <algorithm>
#define ORRERY_UNSEEN __attribute__((no_sanitize_thread))  // for worker code before TsanFence::acquire()
#else
#define ORRERY_UNSEEN
#endif

// Parallel loops on oneTBB.
namespace orrery {

// Reports the synchronization between caller and workers to ThreadSanitizer, which cannot see inside oneTBB.
// Does nothing in other builds: oneTBB synchronizes caller and workers.
class TsanFence {
 public:
#ifdef __SANITIZE_THREAD__
  void release() { __tsan_release(this); }
  void acquire() { __tsan_acquire(this); }
#else
  void release() {}
  void acquire() {}
#endif
};

// Calls act(0), ..., act(count - 1) in any order and concurrently, in chunks of at least `grain` / 2 calls.
// Each chunk starts with a checkpoint. Once a call throws, no more chunks start. One of the
// exceptions is rethrown to the caller after the running chunks have ended.
template <class Act>
void parallel_for_each(std::size_t count, std::size_t grain, const Act& act) {
  using Range = tbb::blocked_range<std::size_t>;
  TsanFence to_workers, from_workers;
  const TaskContext work = TaskScope::current();
  const auto some_of = [&](const Range& some) {
    const TaskScope scope(work);
    checkpoint();
    for (std::size_t i = some.begin(); i != some.end(); ++i) act(i);
  };
  to_workers.release();
  tbb::parallel_for(Range(0, count, grain), [&](const Range& some) ORRERY_UNSEEN {
    to_workers.acquire();
    some_of(some);
    from_workers.release();
  });
  from_workers.acquire();
}

// Calls both functions, on two threads if available. If one function throws, the other function may not
// start. One exception is rethrown to the caller after both functions have ended.
template <class First, class Second>
void both_in_parallel(const First& first, const Second& second) {
  TsanFence to_workers, from_workers;
  const TaskContext work = TaskScope::current();
  const auto done = [&](const auto& act) ORRERY_UNSEEN {
    to_workers.acquire();
    const TaskScope scope(work);
    act();
    from_workers.release();
  };
  to_workers.release();
  tbb::parallel_invoke([&]() ORRERY_UNSEEN { done(first); }, [&]() ORRERY_UNSEEN { done(second); });
  from_workers.acquire();
}

// Sorts by operator<, which must not throw. The sort is neither stable nor interruptible.
template <class Iterator>
void sort_in_parallel(Iterator begin, Iterator end) {
#ifdef __SANITIZE_THREAD__
  std::sort(begin, end);  // ThreadSanitizer cannot follow oneTBB's element moves
#else
  tbb::parallel_sort(begin, end);
#endif
}

}  // namespace orrery
