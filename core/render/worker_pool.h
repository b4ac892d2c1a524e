#pragma once

#include <functional>
#include <memory>

#include "core/base/checkpoint.h"

namespace orrery {

// Lease of a loop on its share of the threads, if other loops wait for a lease, too.
class SlotLease {
 public:
  // Returns whether another loop holds the lease. Thread-safe. Must be short, since locks are held.
  virtual bool expired() const = 0;
  // Blocks until the loop holds the lease again. An exception ends the loop.
  virtual void renew() = 0;

 protected:
  ~SlotLease() = default;
};

// Render threads, one pool per process, shared by the frames of all callers. Thread-safe.
class WorkerPool {
 public:
  // Starts `threads` threads, or one per core if it is 0.
  explicit WorkerPool(int threads = 0);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  int threads() const;

  // Runs `task` soon on one of the threads. The task must be short, must not throw and must not block.
  void enqueue(bool background, std::function<void()> task);
  // Calls work(step, worker, turn) for each 0 <= step < count on the threads, and returns after the last.
  // Steps that run at once have different workers, 0 <= worker < threads(). Callers share the threads evenly.
  // A long step must call Turn::yield() now and then to yield to callers that had less time. A step that
  // does not yield for 50 ms shares its core with them. Background callers get the time that others leave.
  // Once a step returns false or throws, no more steps start; the first exception is rethrown here. If
  // `lease` is given and has expired, no step starts and running steps pause when they yield. The caller's
  // thread then renews it.
  using Step = std::function<bool(int step, int worker, TimeSlice& turn)>;
  void for_each(int count, bool background, const Step& work, SlotLease* lease = nullptr);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace orrery
