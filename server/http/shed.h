#pragma once

#include <chrono>
#include <deque>
#include <string_view>

namespace orrery {

// Turns connections away that no thread is free for: answers without reading what they ask. For one thread.
class Shed {
 public:
  static constexpr std::size_t kMost = 128;  // sockets kept open for clients that still send

  ~Shed();
  // Takes the socket. `bytes`: the whole answer.
  void refuse(int fd, std::string_view bytes);
  // Closes the sockets whose clients had the time to read the answer.
  void close_old();
  // When the next of them is to be closed; never, if there is none.
  std::chrono::steady_clock::time_point next_close() const;

 private:
  struct Refused {
    int fd;
    std::chrono::steady_clock::time_point close_at;
  };
  std::deque<Refused> refused_;  // the oldest first
};

}  // namespace orrery
