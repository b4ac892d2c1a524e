#pragma once

#include <functional>
#include <memory>
#include <stop_token>

namespace orrery {

// Handles SIGINT and SIGTERM during its lifetime. The first signal calls `on_first` on a separate thread, the
// second ends the process at once with status 130. Each SIGHUP calls `on_hangup`, if given. Must be created
// before other threads, since only threads started later inherit the blocked signals.
class SignalWatch {
 public:
  explicit SignalWatch(std::function<void()> on_first = {}, std::function<void()> on_hangup = {});
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;

  // Returns the token on which the first signal requests a stop, before it calls `on_first`.
  std::stop_token interrupted() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace orrery
