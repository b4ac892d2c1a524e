#include "server/scheduler/work_account.h"

#include <algorithm>
#include <cstdlib>

namespace orrery {
namespace {

#ifndef ORRERY_SANITIZED  // sanitizers replace operator new themselves
// Header in front of each block of operator new.
struct alignas(__STDCPP_DEFAULT_NEW_ALIGNMENT__) Header {
  WorkAccount* account;
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
  WorkAccount* const account = WorkAccount::current();
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

std::shared_ptr<WorkAccount> WorkAccount::open(Source source) {
  const TaskScope nobody({});
  return {new WorkAccount(std::move(source)), [](WorkAccount* account) { account->close(); }};
}

void WorkAccount::close() {
  const TaskScope nobody({});
  {
    const std::lock_guard lock(mutex_);
    resize_ = nullptr;
  }
  remove(kOpen);
}

void WorkAccount::add(std::size_t bytes) {
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

void WorkAccount::remove(std::size_t bytes) noexcept {
  if (held_.fetch_sub(bytes) == bytes) delete this;
}

// Requests a higher limit for the bytes in use. Returns false if the request was refused.
bool WorkAccount::grow() {
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

void WorkAccount::settle(std::size_t bytes) {
  const TaskScope nobody({});
  const std::lock_guard lock(mutex_);
  settled_ = bytes;
  resize_locked(true);
}

// REQUIRES: mutex_ is held.
void WorkAccount::resize_locked(bool already) {
  const std::size_t held = bytes(), settled = std::min(held, settled_);
  granted_ = resize_ ? settled + resize_(held - settled, already) : held;
}

void WorkAccount::rethrow_refusal() {
  const std::lock_guard lock(mutex_);
  if (refusal_) std::rethrow_exception(refusal_);
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
