#pragma once

#include <string>

namespace orrery {

// A listening TCP socket. Not thread-safe: one thread accepts connections.
class Listener {
 public:
  // Port 0 selects a free port. Throws Error if the address is unavailable.
  Listener(const std::string& host, int port);
  ~Listener();
  Listener(const Listener&) = delete;

  int fd() const { return fd_; }
  int port() const { return port_; }

  // Returns the socket of the next connection, or -1 if none is pending or accepting fails.
  int accept();
  // Whether the last accept() failed for lack of descriptors or memory.
  bool out_of_room() const { return out_of_room_; }

 private:
  int fd_ = -1, port_ = 0;
  bool out_of_room_ = false;
};

// Whether `host`, a name or an address, can be reached from this machine only. Throws Error if it cannot be
// resolved.
bool is_loopback(const std::string& host);

}  // namespace orrery
