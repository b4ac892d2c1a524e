#include "server/app/watch.h"

#include <string>

namespace orrery {

bool Watch::stop() const {
  constexpr std::chrono::milliseconds kAskEvery{5};
  const auto now = Clock::now();
  if (program_ends_ || has_gone_ || now >= deadline_) return true;
  if (now < ask_at_.load()) return false;
  ask_at_ = now + kAskEvery;
  if (gone_()) has_gone_ = true;
  return has_gone_;
}

void Watch::explain() const {
  if (has_gone_) throw Cancelled("the client has gone");  // whoever has come to wait since
  if (program_ends_) throw Busy("The service ends", 5);
  throw TimedOut("It took more than " + std::to_string(limit_.count()) + " s (" + limit_name_ +
                 "); fewer pixels or samples take less");
}

}  // namespace orrery
