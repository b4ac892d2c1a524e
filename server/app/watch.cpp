#include "server/app/watch.h"

#include <string>

namespace orrery {

void Watch::explain() const {
  if (gone_()) throw Cancelled("the client has gone");
  if (program_ends_) throw Busy("The service ends", 5);
  throw TimedOut("It took more than " + std::to_string(limit_.count()) + " s (" + limit_name_ +
                 "); fewer pixels or samples take less");
}

}  // namespace orrery
