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

// Bytes that a piece of work holds: operator new adds to the account of the WorkScope that its thread is in,
// operator delete takes off the account that was added to, on whichever thread. What lives longer than its
// account is nobody's. Safe from any thread.
class MemoryAccount : public std::enable_shared_from_this<MemoryAccount> {
 public:
  // Asked for the right to hold so many bytes in all, more or fewer than before. Returns how many it may hold
  // from now on, at least that; or throws why it may not hold more, unless it holds them `already`.
  using Resize = std::function<std::size_t(std::size_t bytes, bool already)>;
  // `source`: called for this account, and for those that open_another() gives. Closes with its last owner.
  using Source = std::function<Resize()>;
  static std::shared_ptr<MemoryAccount> open(Source source);
  std::shared_ptr<MemoryAccount> open_another() const { return open(source_); }  // of the same source
  MemoryAccount(const MemoryAccount&) = delete;

  std::size_t bytes() const { return held_ - kOpen; }  // also what the allocator adds to each block

  // From now on, others answer for so many of the bytes: they need no right.
  void settle(std::size_t bytes);

  // Calls work() with the thread in the scope of this account and of `stop`, and of the same turn as before.
  // Where that threw because the account was refused more bytes, throws what refused them.
  template <class Act>
  auto run(const std::stop_token& stop, const Act& work);

  // Where it may not hold a block of 32 MiB or more, that throws std::bad_alloc. Smaller ones are always
  // taken, so that nothing fails where nobody expects it, but require_granted() throws afterwards.
  void add(std::size_t bytes);
  void remove(std::size_t bytes);
  void require_granted() {
    if (overdrawn_ && !grow()) throw std::bad_alloc();
  }

 private:
  static constexpr std::size_t kOpen = 1;  // in held_ until it is closed; blocks have even sizes

  explicit MemoryAccount(Source source) : source_(std::move(source)), resize_(source_()) {}
  void close();
  bool grow();
  void resize_locked(bool already);
  void rethrow_refusal();

  const Source source_;
  std::atomic<std::size_t> held_{kOpen}, granted_{0};
  std::atomic<bool> overdrawn_{false};
  std::mutex mutex_;  // guards all below
  Resize resize_;     // none: closed
  std::size_t settled_ = 0;
  std::exception_ptr refusal_;
};

// What a thread works for; the pointers may be null.
struct Work {
  MemoryAccount* memory = nullptr;        // whose memory it takes
  const std::stop_token* stop = nullptr;  // ends it
  Turn* turn = nullptr;                   // on which it works; asked from any thread
};

// Sets what this thread works for, until its end. Workers that a caller waits for are in its scope as well.
class WorkScope {
 public:
  explicit WorkScope(const Work& work);
  ~WorkScope();
  WorkScope(const WorkScope&) = delete;

  static Work current();

 private:
  const Work before_;
};

// Bytes that are taken in another way than by operator new.
class MemoryCharge {
 public:
  MemoryCharge() = default;
  // Adds them to the account that the thread is in, if it is in one. Throws std::bad_alloc.
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
    const WorkScope scope({this, &stop, WorkScope::current().turn});
    return work();
  } catch (const std::bad_alloc&) {
    rethrow_refusal();
    throw;
  }
}

// Lets others go first if they have waited long enough. Throws Cancelled once what the thread works for is to
// end, and std::bad_alloc once it holds more memory than it may. Loops over input of any size ask it at each
// step, with no lock held that others need; it takes a few ns.
void interruption_point();
// The same for loops of steps that take less: asks at every 4,096th.
inline void interruption_point(std::size_t step) {
  if (step % 4096 == 0) interruption_point();
}

}  // namespace orrery
