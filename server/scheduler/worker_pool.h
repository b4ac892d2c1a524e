#pragma once

#include <functional>
#include <memory>

#include "core/base/task_scope.h"
#include "core/render/executor.h"

namespace orrery {

// Lease of an admission slot. A loop may run steps only while it has the slot. The lease expires if another
// request needs the slot.
class SlotLease {
 public:
  // Returns whether the loop has lost the slot. Thread-safe. Must be fast and must not block, because the
  // pool calls it with its mutex locked.
  virtual bool expired() const = 0;
  // Blocks until the loop has a slot again. Called on the thread that called for_each(). An exception ends
  // the loop.
  virtual void renew() = 0;

 protected:
  ~SlotLease() = default;
};

// Render threads, one pool per process, shared by the frames of all callers. Thread-safe. The constructor
// throws std::system_error if the system cannot start the threads. The destructor waits for all tasks and
// loops.
class WorkerPool {
 public:
  // Starts `threads` threads, or one per core if it is 0.
  explicit WorkerPool(int threads = 0);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  int threads() const;

  // Runs `task` on one of the threads, before steps that have not started. Does not wait for the task. The
  // task must be short, must not throw and must not block.
  void enqueue(bool background, std::function<void()> task);
  // Runs the steps on the threads; see Executor::for_each(). Callers share the threads evenly. A long step
  // must call checkpoint() every few milliseconds to yield to callers that have used less time. A step that
  // does not yield for 50 ms shares its core with other callers. Background callers run at lower priority. If
  // `lease` is not null and has expired, no step starts, and running steps pause at their next checkpoint.
  // The caller's thread then renews the lease.
  void for_each(int count, bool background, const Executor::Step& work, SlotLease* lease = nullptr);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

// Share of the pool for one render.
struct PoolExecutor final : Executor {
  explicit PoolExecutor(WorkerPool& threads, bool in_background = false, SlotLease* slot = nullptr)
      : pool(threads), background(in_background), lease(slot) {}

  int threads() const override { return pool.threads(); }
  void for_each(int count, const Step& work) override { pool.for_each(count, background, work, lease); }

  WorkerPool& pool;
  bool background;   // see WorkerPool::for_each()
  SlotLease* lease;  // may be null
};

}  // namespace orrery
