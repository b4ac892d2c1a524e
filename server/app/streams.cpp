#include "server/app/streams.h"

#include "server/scheduler/admission.h"

namespace orrery {

class Streams::Slot {
 public:
  // REQUIRES: of.mutex_ is held.
  Slot(Streams& of, const std::string& client) : of_(of), entry_(of.by_client_.try_emplace(client).first) {
    ++entry_->second;
    ++of_.all_;
  }
  Slot(const Slot&) = delete;
  ~Slot() {
    const std::lock_guard lock(of_.mutex_);
    --of_.all_;
    if (--entry_->second == 0) of_.by_client_.erase(entry_);
  }

 private:
  Streams& of_;
  const std::map<std::string, int>::iterator entry_;
};

std::shared_ptr<const void> Streams::open(const std::string& client) {
  const std::lock_guard lock(mutex_);
  const auto own = by_client_.find(client);
  Quota{.noun = "stream", .state = "open", .limit = "connections", .most = max_, .retry_s = 5}
      .require_one_more(all_, own == by_client_.end() ? 0 : own->second);
  return std::make_shared<const Slot>(*this, client);
}

}  // namespace orrery
