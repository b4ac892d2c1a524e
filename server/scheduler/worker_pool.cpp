#include "server/scheduler/worker_pool.h"

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
#include <utility>
#include <vector>

#include "core/base/clock.h"

namespace orrery {

namespace {

// Length of a time slice while other steps or tasks wait, and the time after which a step or task that has
// not yielded loses its place.
constexpr std::chrono::milliseconds kSlice{20}, kOverdue{50};

// Threads that share their time evenly between several loops.
//
// A place is the right to run a step or task. There are `count` places. A step that yields gives its place to
// another step and blocks its thread. Each loop therefore requires at most `count` more threads. A step that
// does not yield in time loses its place but continues to run. The operating system then shares the cores
// between this step and the new owner of the place.
//
// A TBB task arena is not used: while a caller waits for its last tile, TBB may make its thread run the whole
// frame of another caller. A small image would then wait for a large one.
class WorkerThreads {
 public:
  WorkerThreads(int count, int niceness) : count_(count), niceness_(niceness), idle_(count) {
    try {
      for (int i = 0; i < count; ++i) threads_.emplace_back([this] { serve(); });
      watch_ = std::thread([this] { watch(); });
    } catch (...) {  // std::system_error: the operating system cannot start more threads
      end();
      throw;
    }
  }
  ~WorkerThreads() { end(); }

  int count() const { return count_; }

  void enqueue(std::function<void()> task) {
    {
      const std::lock_guard lock(mutex_);
      tasks_.push_back(std::move(task));
      if (contended()) contended_.notify_one();
    }
    changed_.notify_one();
  }

  void for_each(int count, const Executor::Step& work, SlotLease* lease) {
    if (count == 0) return;
    Loop loop{.work = work, .count = count, .lease = lease, .free_workers = {}};
    for (int worker = count_; worker-- > 0;) loop.free_workers.push_back(worker);
    std::unique_lock lock(mutex_);
    add(loop);
    for (;;) {
      loop.changed.wait(lock, [&] { return loop.over() || loop.pauses(); });
      loops_.remove(&loop);
      if (loop.over()) break;
      lock.unlock();
      std::exception_ptr error;
      try {
        lease->renew();
      } catch (...) {
        error = std::current_exception();
      }
      lock.lock();
      if (error) loop.end(error);
      loop.lease_expired = false;
      add(loop);
    }
    if (loop.error) std::rethrow_exception(loop.error);
  }

 private:
  class StepSlice;
  // One call of for_each(), on the stack of its caller. The fields are guarded by mutex_.
  struct Loop {
    const Executor::Step& work;
    const int count;
    SlotLease* const lease;
    const TaskContext scope = TaskScope::current();  // scope of the caller of for_each()
    std::vector<int> free_workers;
    int next = 0, running = 0;          // next step to start; unfinished steps
    std::list<StepSlice*> paused = {};  // running steps that have yielded
    Clock::duration used{};             // time used by steps; starts at the minimum over the other loops
    std::exception_ptr error = {};
    bool lease_expired = false;
    std::condition_variable changed = {};
    void end(std::exception_ptr why) {
      if (!error) error = why;
      next = count;
    }
    bool pauses() const { return lease_expired && running == static_cast<int>(paused.size()); }
    bool over() const { return next == count && running == 0; }
    bool waits() const {
      return !lease_expired && (!paused.empty() || (next < count && !free_workers.empty()));
    }
  };

  // Place of a running step or task, on the stack of its thread.
  struct Place {
    const Loop* loop;  // null for a task
    Clock::time_point since = Clock::now();
  };

  // Time slice of a step, on the stack of its thread.
  class StepSlice final : public TimeSlice {
   public:
    StepSlice(WorkerThreads& threads, Loop& loop, Place& place)
        : threads_(threads), loop_(loop), place_(place) {}
    void yield() override {
      if (Clock::now() - place_.since >= kSlice) threads_.yield(*this);
    }
    // Adds the time since the last call to the time used by the loop. REQUIRES: mutex_ is held.
    void charge() {
      const auto now = Clock::now();
      loop_.used += now - std::exchange(place_.since, now);
    }

   private:
    friend class WorkerThreads;
    WorkerThreads& threads_;
    Loop& loop_;
    Place& place_;
    bool resumed_ = false;
    std::condition_variable changed_;
  };

  // The functions below require that mutex_ is held, unless they lock it themselves.

  // Adds a loop. Its used time starts at the minimum over the other loops, so it gets no credit for the time
  // before.
  void add(Loop& loop) {
    const auto least = std::min_element(loops_.begin(), loops_.end(),
                                        [](const Loop* a, const Loop* b) { return a->used < b->used; });
    if (least != loops_.end()) loop.used = std::max(loop.used, (*least)->used);
    loops_.push_back(&loop);
    if (may_begin()) changed_.notify_all();
    if (contended()) contended_.notify_one();
  }

  // Returns whether more than one loop or task may need a place. Counts the loops in loops_, the waiting
  // tasks, and the places of running tasks and of loops that are not in loops_ because their lease is being
  // renewed.
  bool contended() const {
    const auto others = std::count_if(places_.begin(), places_.end(), [&](const Place* place) {
      return std::find(loops_.begin(), loops_.end(), place->loop) == loops_.end();
    });
    return loops_.size() + tasks_.size() + static_cast<std::size_t>(others) > 1;
  }
  void end() {
    {
      const std::lock_guard lock(mutex_);
      ends_ = true;
    }
    changed_.notify_all();
    contended_.notify_one();
    if (watch_.joinable()) watch_.join();
    for (std::thread& thread : threads_) thread.join();
  }

  bool place_free() const { return static_cast<int>(places_.size()) < count_; }
  bool has(const Place& place) const {
    return std::find(places_.begin(), places_.end(), &place) != places_.end();
  }

  // Returns the loop that has used the least time among those with waiting steps, or nullptr if no step
  // waits.
  Loop* next_loop() {
    Loop* best = nullptr;
    for (Loop* loop : loops_)
      if (loop->waits() && (!best || loop->used < best->used)) best = loop;
    return best;
  }

  // Returns whether a thread may start a task or a step. First gives free places to paused steps of the loops
  // that are next.
  bool may_begin() {
    while (place_free()) {
      if (!tasks_.empty()) return true;
      Loop* const loop = next_loop();
      if (!loop) return false;
      if (loop->paused.empty()) return true;
      StepSlice& turn = *loop->paused.front();
      loop->paused.pop_front();
      turn.place_.since = Clock::now();
      places_.push_back(&turn.place_);
      turn.resumed_ = true;
      turn.changed_.notify_one();
    }
    return false;
  }

  bool others_wait(const Loop* loop) const {
    return !tasks_.empty() ||
           std::any_of(loops_.begin(), loops_.end(), [&](const Loop* l) { return l != loop && l->waits(); });
  }
  // Returns whether a step of this loop must give up its place: the lease expired, a task waits, or a loop
  // that has used no more time has waiting steps.
  bool is_over(const Loop& loop) {
    if (loop.lease_expired || !tasks_.empty()) return true;
    const Loop* const other = next_loop();
    return other && other != &loop && other->used <= loop.used;
  }

  void ask_pass(Loop& loop) {
    if (!loop.lease || loop.lease_expired || !loop.lease->expired()) return;
    loop.lease_expired = true;
  }

  void yield(StepSlice& turn) {
    Loop& loop = turn.loop_;
    std::unique_lock lock(mutex_);
    turn.charge();
    ask_pass(loop);
    if (has(turn.place_)) {
      if (!is_over(loop) || !thread_for_another()) return;
      places_.remove(&turn.place_);
    }
    loop.paused.push_back(&turn);
    turn.resumed_ = false;
    if (loop.pauses()) loop.changed.notify_one();
    if (may_begin()) changed_.notify_one();
    turn.changed_.wait(lock, [&] { return turn.resumed_; });
  }

  void watch() {
    std::unique_lock lock(mutex_);
    while (!ends_) {
      contended_.wait(lock, [&] { return ends_ || contended(); });
      contended_.wait_for(lock, kOverdue, [&] { return ends_; });
      take_overdue_places();
    }
  }

  void take_overdue_places() {
    const auto until = Clock::now() - kOverdue;
    places_.remove_if([&](const Place* place) {
      return place->since <= until && others_wait(place->loop) && thread_for_another();
    });
    if (may_begin()) changed_.notify_all();
  }

  // Returns whether there are idle threads for all free places and for one more. Starts a thread if one is
  // missing. Returns false if the system cannot start a thread.
  bool thread_for_another() {
    if (idle_ > count_ - static_cast<int>(places_.size())) return true;
    try {
      threads_.emplace_back([this] { serve(); });
    } catch (const std::exception&) {
      return false;
    }
    ++idle_;
    return true;
  }

  void serve() {
    if (niceness_ > 0) setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), niceness_);
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [&] { return may_begin() || ends_; });
      if (ends_ && tasks_.empty() && loops_.empty()) return;
      Loop* const loop = tasks_.empty() ? next_loop() : nullptr;
      Place place{loop};
      places_.push_back(&place);
      --idle_;
      if (loop)
        run_step(lock, *loop, place);
      else
        run_task(lock);
      ++idle_;
      places_.remove(&place);
    }
  }

  void run_task(std::unique_lock<std::mutex>& lock) {
    const std::function<void()> task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    task();
    lock.lock();
  }

  void run_step(std::unique_lock<std::mutex>& lock, Loop& loop, Place& place) {
    const int step = loop.next++, worker = loop.free_workers.back();
    loop.free_workers.pop_back();
    ++loop.running;
    lock.unlock();
    StepSlice turn(*this, loop, place);
    std::exception_ptr error;
    try {
      const TaskScope scope({loop.scope.memory, loop.scope.stop, &turn});
      loop.work(step, worker);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    turn.charge();
    --loop.running;
    loop.free_workers.push_back(worker);
    if (error) loop.end(error);
    ask_pass(loop);
    if (loop.over() || loop.pauses()) loop.changed.notify_one();
  }

  const int count_, niceness_;
  std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  std::deque<std::function<void()>> tasks_;
  std::list<Loop*> loops_;    // in progress
  std::list<Place*> places_;  // places in use
  int idle_;                  // threads without a step or task
  bool ends_ = false;
  std::vector<std::thread> threads_;
  std::condition_variable contended_;
  std::thread watch_;
};

}  // namespace

// Background threads have a higher nice value. The system scheduler therefore prefers foreground threads
// whenever they have steps to run, even within a long tile.
struct WorkerPool::Parts {
  explicit Parts(int count)
      : builders(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count)),
        foreground(count, 0),
        background(count, 10) {}
  tbb::global_control builders;  // limits the oneTBB threads of accelerator builds
  WorkerThreads foreground, background;
};

WorkerPool::WorkerPool(int threads)
    : parts_(std::make_unique<Parts>(threads > 0 ? threads : tbb::info::default_concurrency())) {}
WorkerPool::~WorkerPool() = default;

int WorkerPool::threads() const { return parts_->foreground.count(); }

void WorkerPool::enqueue(bool background, std::function<void()> task) {
  (background ? parts_->background : parts_->foreground).enqueue(std::move(task));
}

void WorkerPool::for_each(int count, bool background, const Executor::Step& work, SlotLease* lease) {
  (background ? parts_->background : parts_->foreground).for_each(count, work, lease);
}

}  // namespace orrery
