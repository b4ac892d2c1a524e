#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace orrery {

// Values by id. Once they take more than the limit, those not used for longest are forgotten; values are
// shared pointers, so who still uses one keeps it alive. Safe from any thread.
template <class Value>
class Lru {
 public:
  explicit Lru(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  struct Added {
    Value value;
    bool known;  // it was there before, and that one is returned
  };
  // `make` gives the value. REQUIRES: bytes <= most_bytes().
  template <class Make>
  Added add(const std::string& id, std::size_t bytes, const Make& make) {
    const std::lock_guard lock(mutex_);
    if (const auto known = entries_.find(id); known != entries_.end()) {
      touch(known->second);
      return {known->second.value, true};
    }
    shrink_to(most_bytes_ - bytes);
    uses_.push_front(id);
    bytes_ += bytes;
    return {entries_.emplace(id, Entry{make(), bytes, uses_.begin()}).first->second.value, false};
  }

  std::optional<Value> find(const std::string& id) {
    const std::lock_guard lock(mutex_);
    const auto found = entries_.find(id);
    if (found == entries_.end()) return {};
    touch(found->second);
    return found->second.value;
  }

  // Whether it was there.
  bool remove(const std::string& id) {
    const std::lock_guard lock(mutex_);
    const auto found = entries_.find(id);
    if (found == entries_.end()) return false;
    erase(found);
    return true;
  }

  // Values that were forgotten for others, since the start.
  std::uint64_t evictions() const {
    const std::lock_guard lock(mutex_);
    return evictions_;
  }
  std::size_t bytes() const {
    const std::lock_guard lock(mutex_);
    return bytes_;
  }
  std::size_t most_bytes() const { return most_bytes_; }

 private:
  struct Entry {
    Value value;
    std::size_t bytes;
    std::list<std::string>::iterator use;
  };
  using Entries = std::map<std::string, Entry>;

  // Below: with mutex_ held.
  void shrink_to(std::size_t most_bytes) {
    for (; bytes_ > most_bytes; ++evictions_) erase(entries_.find(uses_.back()));
  }
  void touch(Entry& entry) { uses_.splice(uses_.begin(), uses_, entry.use); }
  void erase(typename Entries::iterator entry) {
    bytes_ -= entry->second.bytes;
    uses_.erase(entry->second.use);
    entries_.erase(entry);
  }

  const std::size_t most_bytes_;
  mutable std::mutex mutex_;
  Entries entries_;
  std::list<std::string> uses_;  // ids, the latest use first
  std::size_t bytes_ = 0;
  std::uint64_t evictions_ = 0;
};

}  // namespace orrery
