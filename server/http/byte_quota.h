#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "core/base/shorten.h"
#include "server/base/errors.h"

namespace orrery {

// Returns the error message for `takers` that use `taken` of `most` bytes and need `needed` bytes more.
// `limit`: name of the limit in /v1/limits.
inline std::string over_limit_text(const std::string& takers, std::size_t taken, std::size_t most,
                                   const char* limit, std::size_t needed) {
  return takers + " use " + grouped(taken) + " bytes and need " + grouped(needed) + " more (limit " +
         grouped(most) + ", " + limit + ")";
}

// Byte quota shared by all clients. A client may use at most half of it. Its only share and shares of up to
// 64 KiB are exempt from this limit. Thread-safe.
class ByteQuota {
 public:
  // `most`: quota in bytes. `name`: name of the limit in /v1/limits. `takers`: plural subject of error
  // messages ("request bodies").
  ByteQuota(std::size_t most, const char* name, const char* takers)
      : max_(most), name_(name), takers_(takers) {}

  // Bytes charged to a client. The destructor returns them to the quota.
  class Share {
   public:
    Share(ByteQuota& from, std::string client) : from_(from), client_(std::move(client)) {}
    ~Share() { from_.give_back(client_, bytes_); }
    Share(const Share&) = delete;
    // Grows the share to `bytes` in total. Does nothing if it is that large already. Throws LimitExceeded if
    // the quota has too few bytes left, ClientLimitExceeded if the client would exceed its half.
    void grow(std::size_t bytes) {
      if (bytes <= bytes_) return;
      from_.take(client_, bytes_, bytes - bytes_);
      bytes_ = bytes;
    }

   private:
    ByteQuota& from_;
    const std::string client_;
    std::size_t bytes_ = 0;
  };

 private:
  // `own`: bytes charged to the share so far.
  void take(const std::string& client, std::size_t own, std::size_t bytes) {
    constexpr double kRetry_s = 2;
    const std::lock_guard lock(mutex_);
    const auto known = taken_by_.find(client);
    const std::size_t by_client = known == taken_by_.end() ? 0 : known->second;
    constexpr std::size_t kSmall = 64 * 1024;  // bytes; smaller shares are exempt from the client's half
    const bool has_others = by_client > own && own + bytes > kSmall;
    if (has_others && bytes > max_ / 2 - std::min(by_client, max_ / 2))
      throw ClientLimitExceeded(
          over_limit_text(takers_ + " of this client", by_client, max_ / 2, name_, bytes), kRetry_s, name_);
    if (bytes > max_ - taken_)
      throw LimitExceeded(over_limit_text(takers_, taken_, max_, name_, bytes), kRetry_s, name_);
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

  const std::size_t max_;
  const char* const name_;
  const std::string takers_;
  std::mutex mutex_;  // guards the members below
  std::size_t taken_ = 0;
  std::map<std::string, std::size_t> taken_by_;  // by client; no zero entries
};

}  // namespace orrery
