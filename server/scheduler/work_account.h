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

#include "core/base/task_scope.h"

namespace orrery {

// Memory account of one task of the service. operator new charges the account of the current TaskScope.
// operator delete credits the account that was charged for the block, on any thread. A block that outlives
// its account no longer counts toward a limit. Thread-safe.
class WorkAccount final : public MemoryAccount, public std::enable_shared_from_this<WorkAccount> {
 public:
  // Callback that changes the limit of the account to at least `bytes`, which may be more or less than
  // before. Returns the new limit, or throws an exception to refuse. Must not throw if `already` is true,
  // because the bytes are then already allocated.
  using Resize = std::function<std::size_t(std::size_t bytes, bool already)>;
  // Factory of resize callbacks. Called once per account, including accounts from open_another(). The account
  // closes when its last shared_ptr is destroyed.
  using Source = std::function<Resize()>;
  static std::shared_ptr<WorkAccount> open(Source source);
  std::shared_ptr<WorkAccount> open_another() const { return open(source_); }  // uses the same source
  WorkAccount(const WorkAccount&) = delete;

  // Returns the account of the current TaskScope, or null.
  static WorkAccount* current() { return static_cast<WorkAccount*>(TaskScope::current().memory); }

  // Returns the charged bytes, including the header and the rounding of each block.
  std::size_t bytes() const { return held_ - kOpen; }

  // Excludes `bytes` of the account from its limit, because another owner is charged for them.
  void settle(std::size_t bytes);

  // Returns work(), called with this account, `stop` and the current time slice as the thread's TaskScope. If
  // work() throws std::bad_alloc because a Resize callback refused memory, throws the exception of that
  // callback instead.
  template <class Act>
  auto run(const std::stop_token& stop, const Act& work);

  // Throws std::bad_alloc if the block has 32 MiB or more and exceeds the limit, unless an exception is
  // propagating. All other charges succeed, so that code without error handling does not fail. If they exceed
  // the limit, require_granted() throws std::bad_alloc.
  void add(std::size_t bytes) override;
  void remove(std::size_t bytes) noexcept override;
  void require_granted() override {
    if (overdrawn_ && !grow()) throw std::bad_alloc();
  }

 private:
  static constexpr std::size_t kOpen = 1;  // counted in held_ while the account is open; block sizes are even

  explicit WorkAccount(Source source) : source_(std::move(source)), resize_(source_()) {}
  ~WorkAccount() = default;
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

template <class Act>
auto WorkAccount::run(const std::stop_token& stop, const Act& work) {
  try {
    const TaskScope scope({this, &stop, TaskScope::current().time_slice});
    return work();
  } catch (const std::bad_alloc&) {
    rethrow_refusal();
    throw;
  }
}

}  // namespace orrery
