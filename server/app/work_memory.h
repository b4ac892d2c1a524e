#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "core/base/work_scope.h"

namespace orrery {

// Bytes that all pieces of work hold together. A client may hold as many as it leaves to the others: so one
// alone may have half, two may have a third each, and there is always room for a small picture. Safe from any
// thread; outlives the accounts.
class WorkMemory {
 public:
  explicit WorkMemory(std::size_t most_bytes) : most_(most_bytes) {}

  // An account without bytes, for work of that client. Where it may not hold more, its run() throws
  // InputError if there could never be room for it, ClientBusy if the client's other work has it, else
  // OverLimit.
  std::shared_ptr<MemoryAccount> open(const std::string& client);

  std::size_t bytes() const;
  std::size_t most() const { return most_; }

 private:
  class Share;
  // Changes a share of `own` bytes; returns how many it has then.
  std::size_t resize(const std::string& client, std::size_t own, std::size_t bytes, bool already);
  void require_room(const std::string& client, std::size_t own, std::size_t bytes) const;

  const std::size_t most_;
  mutable std::mutex mutex_;  // guards all below
  std::size_t taken_ = 0;
  std::map<std::string, std::size_t> taken_by_;  // clients that have taken some
};

}  // namespace orrery
