#pragma once

#include <cstddef>
#include <stop_token>
#include <utility>

// Cancellation, scheduling and memory limits of long computations. A program that limits its tasks implements
// TimeSlice and MemoryAccount and runs a task within a TaskScope. All loops over input of any size call
// checkpoint().
namespace orrery {

// Time slice of a task on threads for which other tasks may be waiting. Thread-safe.
class TimeSlice {
 public:
  // Blocks until the task may continue. Returns at once if the time slice is not used up or no other task is
  // waiting. An exception ends the task.
  virtual void yield() = 0;

 protected:
  ~TimeSlice() = default;
};

// Memory account of a task. Exists until all charged bytes are removed. Thread-safe.
class MemoryAccount {
 public:
  // Charges memory. An exception, usually std::bad_alloc, refuses it.
  virtual void add(std::size_t bytes) = 0;
  virtual void remove(std::size_t bytes) noexcept = 0;
  // Throws std::bad_alloc if the task exceeds its limit.
  virtual void require_granted() = 0;

 protected:
  ~MemoryAccount() = default;
};

// Context of the task that a thread runs. Each pointer may be null.
struct TaskContext {
  MemoryAccount* memory = nullptr;        // charged for memory of the task
  const std::stop_token* stop = nullptr;  // cancels the task
  TimeSlice* time_slice = nullptr;        // any thread may call yield()
};

// Sets the calling thread's context until the end of the scope. parallel_for_each(), both_in_parallel() and
// Executor::for_each() pass the context to their workers.
class TaskScope {
 public:
  explicit TaskScope(const TaskContext& work);
  ~TaskScope();
  TaskScope(const TaskScope&) = delete;

  static TaskContext current();

 private:
  const TaskContext before_;
};

// Charge for memory that is not allocated by operator new.
class MemoryCharge {
 public:
  MemoryCharge() = default;
  // Charges the account of the current TaskScope, if any. Throws the exceptions of MemoryAccount::add().
  explicit MemoryCharge(std::size_t bytes);
  ~MemoryCharge();
  MemoryCharge(MemoryCharge&& from) noexcept
      : account_(std::exchange(from.account_, nullptr)), bytes_(from.bytes_) {}
  MemoryCharge& operator=(MemoryCharge&& from) noexcept {
    std::swap(account_, from.account_);
    std::swap(bytes_, from.bytes_);
    return *this;
  }

 private:
  MemoryAccount* account_ = nullptr;
  std::size_t bytes_ = 0;
};

// Yields to waiting tasks if the time slice is used up. Throws Cancelled if a stop was requested, and
// std::bad_alloc if the task exceeds its memory limit. Takes a few ns, so loops over input of any size call
// it at each step. REQUIRES: if the TaskScope has a time slice, the caller holds no lock that other tasks
// need.
void checkpoint();
// Calls checkpoint() if `step` is a multiple of 4,096, for loops with short steps.
inline void checkpoint(std::size_t step) {
  if (step % 4096 == 0) checkpoint();
}

}  // namespace orrery
