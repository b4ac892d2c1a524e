#include "server/scheduler/watch.h"

#include <string>

namespace orrery {

WorkCancellation::WorkCancellation(const std::stop_token& gone, const std::stop_token& service_ends,
                                   Timer& timer, Clock::time_point since, const Limit& limit)
    : limit_(limit),
      on_gone_(gone, Stop{*this, Reason::gone}),
      on_end_(service_ends, Stop{*this, Reason::service_ends}),
      on_time_(timer.at(since + limit.time, Stop{*this, Reason::time})) {}

void WorkCancellation::Stop::operator()() const {
  Reason none = Reason::none;
  if (watch.reason_.compare_exchange_strong(none, reason)) watch.source_.request_stop();
}

void WorkCancellation::explain() const {
  switch (reason_) {
    case Reason::service_ends: throw Busy("service is shutting down", 5);
    case Reason::time:
      throw TimedOut("request took too long (limit " + std::to_string(limit_.time.count()) + " s, " +
                     limit_.name + "); use fewer pixels or samples");
    default: throw Cancelled("client disconnected");
  }
}

}  // namespace orrery
