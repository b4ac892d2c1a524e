#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "server/base/fair_shares.h"

namespace orrery {

// Size-limited cache of values, which are keyed by id and held by clients. FairShares selects the values to
// evict. Values are shared pointers, so an evicted value lives as long as it is used. Thread-safe.
template <class Value>
class Lru {
 public:
  // `protected_for`: see FairShares.
  Lru(std::size_t max_bytes, Clock::duration protected_for) : max_bytes_(max_bytes), shares_(protected_for) {}

  struct AddResult {
    Value value;
    bool known;  // it was already stored
  };
  // Returns the value stored under `id`, or stores make() with a weight of `bytes`. Makes the client a
  // holder. Returns nullopt if the value cannot be stored; see FairShares::make_room(). REQUIRES: bytes <=
  // max_bytes().
  template <class Make>
  std::optional<AddResult> add(const std::string& id, const std::string& client, std::size_t bytes,
                               const Make& make) {
    const std::lock_guard lock(mutex_);
    auto known = values_.find(id);
    const bool is_known = known != values_.end();
    if (!is_known) {
      const auto evicted = shares_.make_room(client, bytes, max_bytes_, {});
      if (!evicted) return std::nullopt;
      evictions_ += evicted->size();
      for (const std::string& other : *evicted) values_.erase(other);
      known = values_.emplace(id, make()).first;
    }
    shares_.hold(id, client);
    if (!is_known) shares_.set_weight(id, bytes);
    return AddResult{known->second, is_known};
  }

  std::optional<Value> find(const std::string& id) {
    const std::lock_guard lock(mutex_);
    const auto found = values_.find(id);
    if (found == values_.end()) return {};
    shares_.touch(id);
    return found->second;
  }

  enum class Removed { yes, not_held, unknown };
  // Releases the value for the client, or with `of_all` for all clients. Removes it once no client holds it.
  Removed remove(const std::string& id, const std::string& client, bool of_all) {
    const std::lock_guard lock(mutex_);
    if (values_.count(id) == 0) return Removed::unknown;
    if (!of_all && !shares_.holds(id, client)) return Removed::not_held;
    if (of_all) shares_.erase(id);
    if (of_all || shares_.release(id, client)) values_.erase(id);
    return Removed::yes;
  }

  // Returns the number of evictions since the start.
  std::uint64_t evictions() const {
    const std::lock_guard lock(mutex_);
    return evictions_;
  }
  std::size_t bytes() const {
    const std::lock_guard lock(mutex_);
    return shares_.weight();
  }
  std::size_t max_bytes() const { return max_bytes_; }

 private:
  const std::size_t max_bytes_;
  mutable std::mutex mutex_;  // guards the members below
  std::map<std::string, Value> values_;
  FairShares shares_;
  std::uint64_t evictions_ = 0;
};

}  // namespace orrery
