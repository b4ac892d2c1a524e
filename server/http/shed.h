#pragma once

#include <chrono>
#include <deque>

namespace orrery {

// Turns connections away that no thread is free for: answers 503 without reading what they ask. For one
// thread.
class Shed {
 public:
  ~Shed();
  // Takes the socket.
  void refuse(int fd);
  // Closes the sockets whose clients had the time to read the answer.
  void close_old();

 private:
  struct Refused {
    int fd;
    std::chrono::steady_clock::time_point since;
  };
  std::deque<Refused> refused_;  // the oldest first
};

}  // namespace orrery
