#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "server/scheduler/work_account.h"

namespace orrery {

// Memory quota for all work. A client may hold at most as many bytes as stay free: one client alone may hold
// half, two clients a third each. Accounts of up to 512 KiB are always granted. Thread-safe. Must outlive its
// accounts.
class WorkMemory {
 public:
  explicit WorkMemory(std::size_t max_bytes) : max_(max_bytes) {}

  // Opens an empty account for work of the client. Its run() throws InputError if the work could never fit.
  // It throws ClientLimitExceeded if other work of the client holds the memory, and LimitExceeded if work of
  // other clients does.
  std::shared_ptr<WorkAccount> open(const std::string& client);

  std::size_t bytes() const;
  std::size_t most() const { return max_; }

 private:
  class Share;
  // Resizes a share of `own` bytes to at least `bytes`. Returns the new size. Skips the quota check if the
  // bytes are `already` in use.
  std::size_t resize(const std::string& client, std::size_t own, std::size_t bytes, bool already);
  void require_room(const std::string& client, std::size_t own, std::size_t bytes) const;

  const std::size_t max_;
  mutable std::mutex mutex_;  // guards the members below
  std::size_t taken_ = 0;
  std::map<std::string, std::size_t> taken_by_;  // by client; clients with 0 bytes are absent
};

}  // namespace orrery
