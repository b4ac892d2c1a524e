#include "core/base/task_scope.h"

#include <algorithm>
#include <cstdlib>

#include "core/base/error.h"

namespace orrery {
namespace {

// The initial-exec model avoids a function call per access. It is valid because this library is loaded at
// program start.
[[gnu::tls_model("initial-exec")]] constinit thread_local TaskContext current_task;

#ifndef ORRERY_SANITIZED  // sanitizers replace operator new themselves
// Header in front of each block of operator new.
struct alignas(__STDCPP_DEFAULT_NEW_ALIGNMENT__) Header {
  MemoryAccount* account;
  std::size_t bytes;
};

// Large blocks start on a cache line, as the allocator's own large blocks do. Arrays of nodes then straddle
// as few lines as possible.
constexpr std::size_t kCacheLine = 64, kLargeBlock = 4096;
constexpr std::size_t kOnCacheLine = 1;  // flag in Header::bytes; sizes are even

// Returns the distance from the allocator's pointer to the block, in bytes.
std::size_t offset_of(std::size_t alignment) { return std::max(sizeof(Header), alignment); }

Header& header_of(void* block) { return *(static_cast<Header*>(block) - 1); }

void* take_block(std::size_t size, std::size_t alignment) {
  const bool on_cache_line = size >= kLargeBlock && alignment < kCacheLine;
  if (on_cache_line) alignment = kCacheLine;
  constexpr std::size_t kChunk = 16;  // malloc's granularity in bytes
  const std::size_t offset = offset_of(alignment), all = (size + offset + kChunk - 1) / kChunk * kChunk;
  if (all < size) throw std::bad_alloc();
  MemoryAccount* const account = current_task.memory;
  if (account) account->add(all);
  void* const start = alignment > sizeof(Header)
                          ? std::aligned_alloc(alignment, (all + alignment - 1) / alignment * alignment)
                          : std::malloc(all);
  if (!start) {
    if (account) account->remove(all);
    throw std::bad_alloc();
  }
  void* const block = static_cast<std::byte*>(start) + offset;
  header_of(block) = {account, all | (on_cache_line ? kOnCacheLine : 0)};
  return block;
}

void give_block(void* block, std::size_t alignment) noexcept {
  if (!block) return;
  const Header header = header_of(block);
  if (header.bytes & kOnCacheLine) alignment = kCacheLine;
  std::free(static_cast<std::byte*>(block) - offset_of(alignment));
  if (header.account) header.account->remove(header.bytes & ~kOnCacheLine);
}

#endif

}  // namespace

std::shared_ptr<MemoryAccount> MemoryAccount::open(Source source) {
  const TaskScope nobody({});
  return {new MemoryAccount(std::move(source)), [](MemoryAccount* account) { account->close(); }};
}

void MemoryAccount::close() {
  const TaskScope nobody({});
  {
    const std::lock_guard lock(mutex_);
    resize_ = nullptr;
  }
  remove(kOpen);
}

void MemoryAccount::add(std::size_t bytes) {
  // Larger than any allocation in nlohmann::json's destructor for the largest allowed document, because a
  // destructor must not throw.
  constexpr std::size_t kLarge = 32 << 20;
  if (held_.fetch_add(bytes) + bytes <= granted_ + kOpen) return;
  const bool taken_anyhow = bytes < kLarge || std::uncaught_exceptions() > 0;
  if ((taken_anyhow && overdrawn_) || grow()) return;
  if (taken_anyhow) {
    overdrawn_ = true;
    return;
  }
  remove(bytes);
  throw std::bad_alloc();
}

void MemoryAccount::remove(std::size_t bytes) {
  if (held_.fetch_sub(bytes) == bytes) delete this;
}

// Requests a higher limit for the bytes in use. Returns false if the request was refused.
bool MemoryAccount::grow() {
  const TaskScope nobody({});
  const std::lock_guard lock(mutex_);
  try {
    if (bytes() > granted_) resize_locked(false);
  } catch (...) {
    refusal_ = std::current_exception();
    return false;
  }
  refusal_ = nullptr;
  overdrawn_ = false;
  return true;
}

void MemoryAccount::settle(std::size_t bytes) {
  const TaskScope nobody({});
  const std::lock_guard lock(mutex_);
  settled_ = bytes;
  resize_locked(true);
}

// REQUIRES: mutex_ is held.
void MemoryAccount::resize_locked(bool already) {
  const std::size_t held = bytes(), settled = std::min(held, settled_);
  granted_ = resize_ ? settled + resize_(held - settled, already) : held;
}

void MemoryAccount::rethrow_refusal() {
  const std::lock_guard lock(mutex_);
  if (refusal_) std::rethrow_exception(refusal_);
}

TaskScope::TaskScope(const TaskContext& work) : before_(std::exchange(current_task, work)) {}
TaskScope::~TaskScope() { current_task = before_; }
TaskContext TaskScope::current() { return current_task; }

MemoryCharge::MemoryCharge(std::size_t bytes) : account_(current_task.memory), bytes_(bytes) {
  if (account_) account_->add(bytes_);
}
MemoryCharge::~MemoryCharge() {
  if (account_) account_->remove(bytes_);
}

void interruption_point() {
  if (current_task.time_slice) current_task.time_slice->yield();
  if (current_task.stop && current_task.stop->stop_requested()) throw Cancelled();
  if (current_task.memory) current_task.memory->require_granted();
}

}  // namespace orrery

#ifndef ORRERY_SANITIZED
void* operator new(std::size_t size) { return orrery::take_block(size, __STDCPP_DEFAULT_NEW_ALIGNMENT__); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return orrery::take_block(size, static_cast<std::size_t>(alignment));
}
// Nothrow versions, because the standard library's versions may bypass the operators above.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return operator new(size);
  } catch (...) {
    return nullptr;
  }
}
void* operator new(std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  try {
    return operator new(size, alignment);
  } catch (...) {
    return nullptr;
  }
}
void operator delete(void* block) noexcept { orrery::give_block(block, __STDCPP_DEFAULT_NEW_ALIGNMENT__); }
void operator delete(void* block, std::size_t) noexcept { operator delete(block); }
void operator delete(void* block, std::align_val_t alignment) noexcept {
  orrery::give_block(block, static_cast<std::size_t>(alignment));
}
void operator delete(void* block, std::size_t, std::align_val_t alignment) noexcept {
  operator delete(block, alignment);
}
#endif
