#pragma once

#include <functional>
#include <memory>
#include <stop_token>

namespace orrery {

// Handles SIGINT and SIGTERM during its lifetime. The first signal calls `on_first` on a separate thread, the
// second ends the process at once with status 130. With `on_hangup`, each SIGHUP calls it. Create it before
// other threads, since only threads started later leave the signals to it.
class SignalWatch {
 public:
  explicit SignalWatch(std::function<void()> on_first = {}, std::function<void()> on_hangup = {});
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;

  // Stop requested by the first signal, before `on_first` is called.
  std::stop_token interrupted() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace orrery
