#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>

namespace orrery {

// Clients that wait for the same work, once for each request. Guarded by Admission.
using Sharers = std::multiset<std::string>;

// Sharers by key, for as long as a caller holds them. Safe from any thread.
class SharersByKey {
 public:
  std::shared_ptr<Sharers> of(const std::string& key) {
    const std::lock_guard lock(mutex_);
    std::erase_if(sharers_, [](const auto& entry) { return entry.second.expired(); });
    std::weak_ptr<Sharers>& known = sharers_[key];
    auto sharers = known.lock();
    if (!sharers) known = sharers = std::make_shared<Sharers>();
    return sharers;
  }

 private:
  std::mutex mutex_;
  std::map<std::string, std::weak_ptr<Sharers>> sharers_;  // guarded by mutex_
};

}  // namespace orrery
