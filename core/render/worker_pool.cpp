#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <list>
#include <mutex>
#include <thread>
#include <vector>

#include "core/base/clock.h"
#include "core/render/worker_pool.h"

namespace orrery {

namespace {

// Threads that work on several loops at once, on each for as long as on the others.
//
// They are our own rather than a task arena's: there, a caller that waits for its last tile may be handed the
// whole of another's frame to do first, and a small picture waits for a large one.
class WorkerThreads {
 public:
  WorkerThreads(int count, int niceness) {
    for (int i = 0; i < count; ++i)
      threads_.emplace_back([this, i, niceness] {
        if (niceness > 0) setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), niceness);
        serve(i);
      });
  }
  ~WorkerThreads() {
    {
      const std::lock_guard lock(mutex_);
      ends_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

  int threads() const { return static_cast<int>(threads_.size()); }

  void enqueue(std::function<void()> task) {
    {
      const std::lock_guard lock(mutex_);
      tasks_.push_back(std::move(task));
    }
    changed_.notify_one();
  }

  void for_each(int count, const WorkerPool::Step& work) {
    if (count == 0) return;
    Loop loop{.work = work, .count = count};
    std::unique_lock lock(mutex_);
    if (!loops_.empty()) loop.used = (*next_loop())->used;
    loops_.push_back(&loop);
    changed_.notify_all();
    loop.finished.wait(lock, [&] { return loop.over(); });
    if (loop.error) std::rethrow_exception(loop.error);
  }

 private:
  // A call of for_each(): lives on its caller's stack.
  struct Loop {
    const WorkerPool::Step& work;
    const int count;
    int next = 0, running = 0;
    Clock::duration used{};  // time spent on it, beside that of loops which were there when it came
    std::exception_ptr error = {};
    std::condition_variable finished = {};
    bool over() const { return next == count && running == 0; }
  };

  void serve(int thread) {
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [&] { return ends_ || !tasks_.empty() || !loops_.empty(); });
      if (!tasks_.empty())
        run_task(lock);
      else if (!loops_.empty())
        run_step(lock, thread);
      else
        return;
    }
  }

  void run_task(std::unique_lock<std::mutex>& lock) {
    const std::function<void()> task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    task();
    lock.lock();
  }

  std::list<Loop*>::iterator next_loop() {
    return std::min_element(loops_.begin(), loops_.end(),
                            [](const Loop* a, const Loop* b) { return a->used < b->used; });
  }

  void run_step(std::unique_lock<std::mutex>& lock, int thread) {
    const auto place = next_loop();
    Loop& loop = **place;
    const int step = loop.next++;
    ++loop.running;
    if (loop.next == loop.count) loops_.erase(place);
    lock.unlock();
    const auto start = Clock::now();
    std::exception_ptr error;
    bool go_on = false;
    try {
      go_on = loop.work(step, thread);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    --loop.running;
    loop.used += Clock::now() - start;
    if (!loop.error) loop.error = error;
    if (!go_on && loop.next < loop.count) {
      loop.next = loop.count;
      loops_.remove(&loop);
    }
    if (loop.over()) loop.finished.notify_one();
  }

  std::mutex mutex_;  // guards all but the threads
  std::condition_variable changed_;
  std::deque<std::function<void()>> tasks_;
  std::list<Loop*> loops_;  // with steps left
  bool ends_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace

// The machine's scheduler takes a core from the background whenever the foreground has work, however long its
// tiles are.
struct WorkerPool::Parts {
  explicit Parts(int count)
      : builders(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count)),
        foreground(count, 0),
        background(count, 10) {}
  tbb::global_control builders;  // what builds structures takes no more threads than what renders
  WorkerThreads foreground, background;
};

WorkerPool::WorkerPool(int threads)
    : parts_(std::make_unique<Parts>(threads > 0 ? threads : tbb::info::default_concurrency())) {}
WorkerPool::~WorkerPool() = default;

int WorkerPool::threads() const { return parts_->foreground.threads(); }

void WorkerPool::enqueue(bool background, std::function<void()> task) {
  (background ? parts_->background : parts_->foreground).enqueue(std::move(task));
}

void WorkerPool::for_each(int count, bool background, const Step& work) {
  (background ? parts_->background : parts_->foreground).for_each(count, work);
}

}  // namespace orrery
