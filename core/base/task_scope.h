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
// credits the account that was charged for the block, on any thread. A block that outlives its account no
// longer counts toward a limit. Thread-safe.
class MemoryAccount : public std::enable_shared_from_this<MemoryAccount> {
 public:
  // Callback that changes the limit of the account to at least `bytes`, which may be more or less than
  // before. Returns the new limit, or throws an exception to refuse. Must not throw if `already` is true,
  // because the bytes are then already allocated.
  using Resize = std::function<std::size_t(std::size_t bytes, bool already)>;
  // Factory of resize callbacks. Called once per account, including accounts from open_another(). The account
  // closes when its last shared_ptr is destroyed.
  using Source = std::function<Resize()>;
  static std::shared_ptr<MemoryAccount> open(Source source);
  std::shared_ptr<MemoryAccount> open_another() const { return open(source_); }  // uses the same source
  MemoryAccount(const MemoryAccount&) = delete;

  // Returns the charged bytes, including the header and the rounding of each block.
  std::size_t bytes() const { return held_ - kOpen; }

  // Excludes `bytes` of the account from its limit, because another owner is charged for them.
  void settle(std::size_t bytes);

  // Returns work(), called with this account, `stop` and the current time slice as the thread's TaskScope. If
  // work() throws std::bad_alloc because a Resize callback refused memory, throws the exception of that
  // callback instead.
  template <class Act>
  auto run(const std::stop_token& stop, const Act& work);

  // Charges a block. Throws std::bad_alloc if the block has 32 MiB or more and exceeds the limit, unless an
  // exception is propagating. All other charges succeed, so that code without error handling does not fail.
  // If they exceed the limit, require_granted() throws std::bad_alloc.
  void add(std::size_t bytes);
  void remove(std::size_t bytes);
  void require_granted() {
    if (overdrawn_ && !grow()) throw std::bad_alloc();
  }

 private:
  static constexpr std::size_t kOpen = 1;  // counted in held_ while the account is open; block sizes are even

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
  TimeSlice* time_slice = nullptr;        // time slice of the task; any thread may call yield()
};

// Sets the calling thread's context until the end of the scope. parallel_for_each() and both_in_parallel()
// pass the context to their workers.
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
  // Charges the account of the current TaskScope, if any. Throws like MemoryAccount::add().
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
// it at each step. REQUIRES: if the TaskScope has a time slice, the caller holds no lock that other tasks
// need.
void interruption_point();
// Calls interruption_point() if `step` is a multiple of 4,096, for loops with short steps.
inline void interruption_point(std::size_t step) {
  if (step % 4096 == 0) interruption_point();
}

}  // namespace orrery
