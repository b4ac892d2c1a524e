#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>

namespace orrery {

// Clients that wait for the same work, with one element for each request. Guarded by the mutex of Admission.
using Subscribers = std::multiset<std::string>;

// Subscribers by key, which exist as long as a caller holds them. Thread-safe.
class SubscribersByKey {
 public:
  std::shared_ptr<Subscribers> of(const std::string& key) {
    const std::lock_guard lock(mutex_);
    std::erase_if(subscribers_, [](const auto& entry) { return entry.second.expired(); });
    std::weak_ptr<Subscribers>& known = subscribers_[key];
    auto subscribers = known.lock();
    if (!subscribers) known = subscribers = std::make_shared<Subscribers>();
    return subscribers;
  }

 private:
  std::mutex mutex_;
  std::map<std::string, std::weak_ptr<Subscribers>> subscribers_;  // guarded by mutex_
};

}  // namespace orrery
