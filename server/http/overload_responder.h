#pragma once

#include <chrono>
#include <deque>
#include <string_view>

namespace orrery {

// Rejects connections for which no thread is free, without reading their requests. Not thread-safe.
class OverloadResponder {
 public:
  static constexpr std::size_t kMost = 128;  // sockets kept open so that their clients can read the response

  ~OverloadResponder();
  // Takes ownership of the socket and sends `bytes`, the whole response.
  void refuse(int fd, std::string_view bytes);
  // Closes the sockets whose response was sent at least 1 s ago.
  void close_old();
  // Returns the time of the next close, or time_point::max() if no socket is open.
  std::chrono::steady_clock::time_point next_close() const;

 private:
  struct Refused {
    int fd;
    std::chrono::steady_clock::time_point close_at;
  };
  std::deque<Refused> refused_;  // oldest first
};

}  // namespace orrery
