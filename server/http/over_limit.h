#pragma once

#include <string>

#include "core/base/error.h"

namespace orrery {

// There is no room for the work now because a limit of the service is reached.
class OverLimit : public Busy {
 public:
  // limit: its name in /v1/limits; lives as long as the program.
  OverLimit(const std::string& message, double retry_after_s, const char* limit)
      : Busy(message, retry_after_s), limit_(limit) {}
  const char* limit() const noexcept { return limit_; }

 private:
  const char* limit_;
};

// This client has so much under way that what it asks for now, or last, is turned away.
class ClientBusy : public OverLimit {
 public:
  using OverLimit::OverLimit;
};

}  // namespace orrery
