#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "server/base/shared_bytes.h"
#include "server/http/byte_quota.h"

namespace orrery {

// Byte quota of responses being sent. Bytes shared by several connections count once. A client may use half
// of the quota. A response may exceed this half if the client has no other, and the quota if no other
// response is being sent. Thread-safe.
class ResponseQuota {
 public:
  explicit ResponseQuota(std::size_t most) : max_(most) {}

  using Share = std::shared_ptr<const void>;
  // Charges `bytes` to `client` until the share is destroyed. Does not charge up to 64 KiB (null share).
  // Throws LimitExceeded or ClientLimitExceeded.
  Share take(const SharedBytes& bytes, const std::string& client) {
    constexpr std::size_t kFree = 64 * 1024;
    if (bytes.size() <= kFree) return nullptr;
    charge(bytes, client);
    return {bytes.data(), [this, client, bytes](const char*) { release(bytes, client); }};
  }

 private:
  static constexpr const char* kName = "response_buffer_bytes";
  static constexpr double kRetry_s = 2;

  struct Usage {
    std::map<const char*, int> connections;  // number of senders, by address of the bytes
    std::size_t bytes = 0;

    bool has_room(const SharedBytes& more, std::size_t most) const {
      return bytes == 0 || bytes + more.size() <= most || connections.count(more.data()) > 0;
    }
    void add(const SharedBytes& more) {
      if (++connections[more.data()] == 1) bytes += more.size();
    }
    void remove(const SharedBytes& less) {
      if (--connections[less.data()] > 0) return;
      connections.erase(less.data());
      bytes -= less.size();
    }
  };

  void charge(const SharedBytes& bytes, const std::string& client) {
    const std::lock_guard lock(mutex_);
    const auto known = clients_.find(client);
    if (known != clients_.end() && !known->second.has_room(bytes, max_ / 2))
      throw ClientLimitExceeded(
          over_limit_text("responses of this client", known->second.bytes, max_ / 2, kName, bytes.size()),
          kRetry_s, kName);
    if (!all_.has_room(bytes, max_))
      throw LimitExceeded(over_limit_text("responses", all_.bytes, max_, kName, bytes.size()), kRetry_s,
                          kName);
    all_.add(bytes);
    clients_[client].add(bytes);
  }
  void release(const SharedBytes& bytes, const std::string& client) {
    const std::lock_guard lock(mutex_);
    all_.remove(bytes);
    const auto own = clients_.find(client);
    own->second.remove(bytes);
    if (own->second.bytes == 0) clients_.erase(own);
  }

  const std::size_t max_;
  std::mutex mutex_;  // guards the members below
  Usage all_;
  std::map<std::string, Usage> clients_;
};

}  // namespace orrery
