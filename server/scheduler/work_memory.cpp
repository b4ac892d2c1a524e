#include "server/scheduler/work_memory.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/shorten.h"
#include "server/base/errors.h"

namespace orrery {
namespace {

constexpr const char* kName = "work_bytes";
constexpr double kRetry_s = 2;

std::string bytes_text(std::size_t bytes) { return grouped(bytes) + " bytes"; }

}  // namespace

// Bytes of one account, released by the destructor.
class WorkMemory::Share {
 public:
  Share(WorkMemory& from, std::string client) : from_(from), client_(std::move(client)) {}
  ~Share() { from_.resize(client_, bytes_, 0, true); }
  Share(const Share&) = delete;
  std::size_t resize(std::size_t bytes, bool already) {
    return bytes_ = from_.resize(client_, bytes_, bytes, already);
  }

 private:
  WorkMemory& from_;
  const std::string client_;
  std::size_t bytes_ = 0;
};

std::shared_ptr<WorkAccount> WorkMemory::open(const std::string& client) {
  return WorkAccount::open([this, client] {
    return [share = std::make_shared<Share>(*this, client)](std::size_t bytes, bool already) {
      return share->resize(bytes, already);
    };
  });
}

std::size_t WorkMemory::bytes() const {
  const std::lock_guard lock(mutex_);
  return taken_;
}

std::size_t WorkMemory::resize(const std::string& client, std::size_t own, std::size_t bytes, bool already) {
  constexpr std::size_t kStep = 256 * 1024;  // granularity, so that resize() is called less often
  constexpr std::size_t kSmall = 2 * kStep;  // a small image; always granted
  const std::size_t rounded = (bytes + kStep - 1) / kStep * kStep;
  const std::lock_guard lock(mutex_);
  if (rounded == own) return own;
  if (rounded > std::max(own, kSmall) && !already) require_room(client, own, rounded);
  taken_ += rounded - own;
  std::size_t& by_client = taken_by_[client];
  by_client += rounded - own;
  if (by_client == 0) taken_by_.erase(client);
  return rounded;
}

void WorkMemory::require_room(const std::string& client, std::size_t own, std::size_t bytes) const {
  const auto known = taken_by_.find(client);
  const std::size_t others_of_client = (known == taken_by_.end() ? 0 : known->second) - own;
  const std::size_t of_others = taken_ - own - others_of_client;
  // Returns whether at least as many bytes stay free as the client would hold. The sums are below 2^62, so
  // they do not overflow.
  const auto fits = [&](std::size_t others, std::size_t client_has) {
    return others + 2 * (client_has + bytes) <= max_;
  };
  if (fits(of_others, others_of_client)) return;
  if (!fits(0, 0))
    throw InputError("", "request needs at least " + bytes_text(bytes) + " of memory at once (limit " +
                             grouped(max_ / 2) + ", half of " + kName + ")");
  if (fits(of_others, 0))
    throw ClientLimitExceeded("this client's requests already hold " + bytes_text(others_of_client) +
                                  " and need " + grouped(bytes) + " more (limit " + bytes_text(max_) +
                                  " for all clients, " + kName + ")",
                              kRetry_s, kName);
  throw LimitExceeded("other clients' requests hold " + bytes_text(of_others) +
                          ", and this client's requests need " + bytes_text(others_of_client + bytes) +
                          " (limit " + bytes_text(max_) + " for all clients, " + kName + ")",
                      kRetry_s, kName);
}

}  // namespace orrery
