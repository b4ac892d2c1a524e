#pragma once

#include <string>

namespace orrery {

// A socket that waits for connections.
class Listener {
 public:
  // Port 0: a free one. Throws Error if the address cannot be had.
  Listener(const std::string& host, int port);
  ~Listener();
  Listener(const Listener&) = delete;

  int fd() const { return fd_; }
  int port() const { return port_; }

  // The next connection, or -1 if there is none right now, or no room for one.
  int accept();
  // Whether the last accept() found that the process, or the system, has no room for another socket.
  bool out_of_room() const { return out_of_room_; }

 private:
  int fd_ = -1, port_ = 0;
  bool out_of_room_ = false;
};

// Whether only this machine reaches what listens there. REQUIRES: `host` is a name or an address.
bool is_loopback(const std::string& host);

}  // namespace orrery
