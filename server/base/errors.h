#pragma once

#include <string>

#include "core/base/error.h"

namespace orrery {

// Thrown when a limit of the service is reached, so that the request cannot be served now.
class LimitExceeded : public Busy {
 public:
  // `limit`: name in /v1/limits. Must live as long as the program.
  LimitExceeded(const std::string& message, double retry_after_s, const char* limit)
      : Busy(message, retry_after_s), limit_(limit) {}
  const char* limit() const noexcept { return limit_; }

 private:
  const char* limit_;
};

// Thrown when the client has reached its own limit, such as half of a quota.
class ClientLimitExceeded : public LimitExceeded {
 public:
  using LimitExceeded::LimitExceeded;
};

// Thrown when the client may not do what it asked for, such as removing the asset of another client.
class Forbidden : public Error {
 public:
  using Error::Error;
};

}  // namespace orrery
