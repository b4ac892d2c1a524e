#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>

#include "core/base/clock.h"

namespace orrery {

// Timeouts and minimum transfer rate of a connection. All but `idle` apply from the first byte of a request.
struct Timeouts {
  std::chrono::milliseconds idle{15'000};  // between two requests
  std::chrono::milliseconds head{5'000};   // for request line and headers
  // Minimum rate of bodies and responses in each `window`, at least size / `whole` if the size is known. A
  // body or response must end within `whole` + `window`.
  std::size_t bytes_per_s = 1024;
  std::chrono::seconds whole{600};
  std::chrono::seconds window{10};
  std::chrono::milliseconds shutdown_grace{1'000};  // for the remaining bytes of a request at shutdown
};

// Deadline for the next bytes of a message.
class MinimumRate {
 public:
  // `bytes`: size of the message, or 0 if it is unknown.
  MinimumRate(std::size_t bytes, const Timeouts& timeouts)
      : window_(timeouts.window),
        end_(Clock::now() + timeouts.whole + timeouts.window),
        bytes_a_window_(
            static_cast<std::size_t>(window_.count()) *
            std::max(timeouts.bytes_per_s, bytes / static_cast<std::size_t>(timeouts.whole.count()))) {}
  Clock::time_point deadline() const { return std::min(deadline_, end_); }
  // Records the transfer of `bytes` bytes.
  void count(std::size_t bytes) {
    transferred_ += bytes;
    if (transferred_ < bytes_a_window_) return;
    transferred_ = 0;
    deadline_ = Clock::now() + window_;
  }

 private:
  const std::chrono::seconds window_;
  const Clock::time_point end_;
  const std::size_t bytes_a_window_;
  std::size_t transferred_ = 0;  // bytes in this window
  Clock::time_point deadline_ = Clock::now() + window_;
};

}  // namespace orrery
