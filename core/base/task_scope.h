#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <new>
#include <stop_token>
#include <utility>

#include "core/base/checkpoint.h"

namespace orrery {

// Memory account of one task. operator new charges the account of the current TaskScope. operator delete
// credits the account that was charged, on any thread. A block that outlives its account no longer counts
// toward a limit. Thread-safe.
class MemoryAccount : public std::enable_shared_from_this<MemoryAccount> {
 public:
  // Callback that changes the limit of the account to at least `bytes`, which may be more or less than
  // before. Returns the new limit. Throws if it refuses. Does not throw if `already` is true, because the
  // bytes are then allocated already.
  using Resize = std::function<std::size_t(std::size_t bytes, bool already)>;
  // Factory of resize callbacks. Called once per account, including accounts from open_another(). The account
  // closes when its last shared_ptr is destroyed.
  using Source = std::function<Resize()>;
  static std::shared_ptr<MemoryAccount> open(Source source);
  std::shared_ptr<MemoryAccount> open_another() const { return open(source_); }  // uses the same source
  MemoryAccount(const MemoryAccount&) = delete;

  std::size_t bytes() const { return held_ - kOpen; }  // includes the header and the rounding of each block

  // Excludes `bytes` of the account from its limit, because another owner is charged for them.
  void settle(std::size_t bytes);

  // Calls work() with this account, `stop` and the current time slice as the thread's TaskScope. If work()
  // throws std::bad_alloc because the account was refused memory, throws the exception of the refusal
  // instead.
  template <class Act>
  auto run(const std::stop_token& stop, const Act& work);

  // Throws std::bad_alloc if a block of 32 MiB or more exceeds the limit. Smaller blocks always succeed, so
  // that code without error handling does not fail; require_granted() throws afterwards.
  void add(std::size_t bytes);
  void remove(std::size_t bytes);
  void require_granted() {
    if (overdrawn_ && !grow()) throw std::bad_alloc();
  }

 private:
  static constexpr std::size_t kOpen = 1;  // counted in held_ while open; block sizes are even

  explicit MemoryAccount(Source source) : source_(std::move(source)), resize_(source_()) {}
  void close();
  bool grow();
  void resize_locked(bool already);
  void rethrow_refusal();

  const Source source_;
  std::atomic<std::size_t> held_{kOpen}, granted_{0};
  std::atomic<bool> overdrawn_{false};
  std::mutex mutex_;  // guards the members below
  Resize resize_;     // null once the account is closed
  std::size_t settled_ = 0;
  std::exception_ptr refusal_;
};

// Context of the task that a thread runs. Each pointer may be null.
struct TaskContext {
  MemoryAccount* memory = nullptr;        // account charged for allocations
  const std::stop_token* stop = nullptr;  // cancels the task
  TimeSlice* time_slice = nullptr;        // time slice of the task; called from any thread
};

// Sets the calling thread's context until the end of the scope. Parallel helpers that the caller waits for
// inherit it.
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
  // Charges the current account, if there is one. Throws std::bad_alloc.
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

template <class Act>
auto MemoryAccount::run(const std::stop_token& stop, const Act& work) {
  try {
    const TaskScope scope({this, &stop, TaskScope::current().time_slice});
    return work();
  } catch (const std::bad_alloc&) {
    rethrow_refusal();
    throw;
  }
}

// Yields to waiting tasks if the time slice is used up. Throws Cancelled if a stop was requested, and
// std::bad_alloc if the task exceeds its memory limit. Takes a few ns, so loops over input of any size call
// it at each step. REQUIRES: the caller holds no lock that other tasks need.
void interruption_point();
// Calls interruption_point() at every 4,096th step, for loops with short steps.
inline void interruption_point(std::size_t step) {
  if (step % 4096 == 0) interruption_point();
}

}  // namespace orrery
