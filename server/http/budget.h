#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "server/http/over_limit.h"

namespace orrery {

// What is told where `takers` have `taken` bytes and need more than the limit leaves.
inline std::string over_limit_text(const std::string& takers, std::size_t taken, std::size_t most,
                                   const char* limit, std::size_t needed) {
  return takers + " take " + std::to_string(taken) + " bytes already, of at most " + std::to_string(most) +
         " (" + limit + "), and " + std::to_string(needed) + " more are needed";
}

// Bytes that many may take from together. A client may have half of them, or one share of any size, and small
// ones beside. Safe from any thread.
class Budget {
 public:
  // `name`: of the limit, in /v1/limits; `takers`: what errors call those who take, at the start of a
  // sentence.
  Budget(std::size_t most, const char* name, const char* takers)
      : most_(most), name_(name), takers_(takers) {}

  // Bytes taken, given back with the object.
  class Share {
   public:
    Share(Budget& from, std::string client) : from_(from), client_(std::move(client)) {}
    ~Share() { from_.give_back(client_, bytes_); }
    Share(const Share&) = delete;
    // Takes what it has not yet of so many bytes. Throws OverLimit if there are not so many left, ClientBusy
    // if the client has too many.
    void grow(std::size_t bytes) {
      if (bytes <= bytes_) return;
      from_.take(client_, bytes_, bytes - bytes_);
      bytes_ = bytes;
    }

   private:
    Budget& from_;
    const std::string client_;
    std::size_t bytes_ = 0;
  };

 private:
  // `own`: what the share has already.
  void take(const std::string& client, std::size_t own, std::size_t bytes) {
    constexpr double kRetry_s = 2;
    const std::lock_guard lock(mutex_);
    const auto known = taken_by_.find(client);
    const std::size_t by_client = known == taken_by_.end() ? 0 : known->second;
    constexpr std::size_t kSmall = 64 * 1024;  // bytes that a client may have beside a large share
    const bool has_others = by_client > own && own + bytes > kSmall;
    if (has_others && bytes > most_ / 2 - std::min(by_client, most_ / 2))
      throw ClientBusy(over_limit_text(takers_ + " of yours", by_client, most_ / 2, name_, bytes), kRetry_s,
                       name_);
    if (bytes > most_ - taken_)
      throw OverLimit(over_limit_text(takers_, taken_, most_, name_, bytes), kRetry_s, name_);
    taken_by_[client] = by_client + bytes;
    taken_ += bytes;
  }
  void give_back(const std::string& client, std::size_t bytes) {
    if (bytes == 0) return;
    const std::lock_guard lock(mutex_);
    taken_ -= bytes;
    const auto known = taken_by_.find(client);
    if ((known->second -= bytes) == 0) taken_by_.erase(known);
  }

  const std::size_t most_;
  const char* const name_;
  const std::string takers_;
  std::mutex mutex_;  // guards all below
  std::size_t taken_ = 0;
  std::map<std::string, std::size_t> taken_by_;  // clients that have taken some
};

}  // namespace orrery
