#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "server/http/budget.h"
#include "server/http/shared_bytes.h"

namespace orrery {

// Bytes of answers that are being sent: those that several connections share count once. Safe from any
// thread.
class AnswerBudget {
 public:
  explicit AnswerBudget(std::size_t most) : budget_(most, "answers_bytes", "Answers that are being sent") {}

  using Share = std::shared_ptr<const void>;
  // Takes these bytes for as long as the share lives; a few are free. Throws as Budget::Share::grow().
  Share take(const SharedBytes& bytes, const std::string& client) {
    constexpr std::size_t kFree = 64 * 1024;
    if (bytes.size() <= kFree) return nullptr;
    const std::lock_guard lock(mutex_);
    const auto [sent, is_new] = sent_.try_emplace(bytes.data(), budget_, client);
    try {
      sent->second.bytes.grow(bytes.size());
    } catch (...) {
      if (is_new) sent_.erase(sent);
      throw;
    }
    ++sent->second.connections;
    return {bytes.data(), [this](const char* data) { release(data); }};
  }

 private:
  struct Sent {
    Sent(Budget& budget, const std::string& client) : bytes(budget, client) {}
    Budget::Share bytes;  // of the client that asked first
    int connections = 0;
  };

  void release(const char* data) {
    const std::lock_guard lock(mutex_);
    const auto sent = sent_.find(data);
    if (--sent->second.connections == 0) sent_.erase(sent);
  }

  Budget budget_;
  std::mutex mutex_;  // guards sent_
  std::map<const char*, Sent> sent_;
};

}  // namespace orrery
