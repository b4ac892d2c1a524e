#pragma once

#include <functional>
#include <memory>
#include <stop_token>

namespace orrery {

// Takes SIGINT and SIGTERM for itself while it lives. The first one calls `on_first` on a thread of its own;
// a second one ends the process at once with status 130. Threads started meanwhile leave the signals to it,
// so make one before any other thread. With `on_hangup`, SIGHUP calls that, each time.
class SignalWatch {
 public:
  explicit SignalWatch(std::function<void()> on_first = {}, std::function<void()> on_hangup = {});
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;

  // Requested by the first signal, before `on_first` is called.
  std::stop_token interrupted() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace orrery
