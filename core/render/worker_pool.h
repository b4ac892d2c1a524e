#pragma once

#include <functional>
#include <memory>

#include "core/base/checkpoint.h"

namespace orrery {

// The right of a loop to its share of the threads, where others wait for that right as well.
class Pass {
 public:
  // Whether another has it. From any thread, also from several at once; brief, with locks held.
  virtual bool expired() const = 0;
  // Returns when the loop has it again. What it throws ends the loop.
  virtual void renew() = 0;

 protected:
  ~Pass() = default;
};

// The threads that render. One for a process; frames from several callers share them. Safe from any thread.
class WorkerPool {
 public:
  // threads 0: one a core.
  explicit WorkerPool(int threads = 0);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  int threads() const;

  // Has `task` done by one of the threads, soon. It must be short, not throw and not wait.
  void enqueue(bool background, std::function<void()> task);
  // Calls work(step, worker, turn) for each 0 <= step < count on the threads, and returns after the last.
  // Steps that run at once have different workers, 0 <= worker < threads(). Callers share the threads evenly:
  // a long step asks its turn now and then to give way to those that have had less; one that does not for 50
  // ms shares its core with them. Callers in the background
  // have what the others leave. Once a step returns false or throws, no more are begun; what was thrown first
  // is thrown here. Steps ask `pass`, if there is one, now and then: once it has expired none is begun, those
  // that run pause when they ask, and then the caller's thread renews it.
  using Step = std::function<bool(int step, int worker, Turn& turn)>;
  void for_each(int count, bool background, const Step& work, Pass* pass = nullptr);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace orrery
