#pragma once

#include <functional>
#include <memory>

namespace orrery {

// The threads that render. One for a process; frames from several callers share them. Safe from any thread.
class WorkerPool {
 public:
  // threads 0: one a core.
  explicit WorkerPool(int threads = 0);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  int threads() const;

  // Has `task` done by one of the threads, soon. It must not throw and must not wait.
  void enqueue(bool background, std::function<void()> task);
  // Calls work(step, thread) for each 0 <= step < count on the threads, 0 <= thread < threads(), and returns
  // after the last. Callers share the threads evenly; those in the background have what the others leave.
  // Once a step returns false or throws, no more are begun; what was thrown first is thrown here.
  using Step = std::function<bool(int step, int thread)>;
  void for_each(int count, bool background, const Step& work);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace orrery
