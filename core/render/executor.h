#pragma once

#include <functional>
#include <memory>

namespace orrery {

// Threads that render tiles. A program with threads of its own implements this interface.
class Executor {
 public:
  virtual int threads() const = 0;
  // Calls work(step, worker) for each 0 <= step < count in any order and on several threads at once. Returns
  // after the last call. Concurrent calls have different workers, 0 <= worker < threads(). Calls inherit the
  // TaskScope of the caller. Once a call throws, no more calls start, and the first exception is rethrown to
  // the caller after the running calls have ended.
  using Step = std::function<void(int step, int worker)>;
  virtual void for_each(int count, const Step& work) = 0;

 protected:
  ~Executor() = default;
};

// Executor on threads of oneTBB. While it exists, oneTBB uses at most that many threads in the whole process.
// Thread-safe.
class ThreadExecutor final : public Executor {
 public:
  // Uses `threads` threads, or one per core if it is 0.
  explicit ThreadExecutor(int threads = 0);
  ~ThreadExecutor();
  int threads() const override;
  void for_each(int count, const Step& work) override;

 private:
  struct Threads;
  const std::unique_ptr<Threads> threads_;
};

}  // namespace orrery
