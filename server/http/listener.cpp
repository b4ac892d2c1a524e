#include "server/http/listener.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include "core/base/error.h"

namespace orrery {
namespace {

using Addresses = std::unique_ptr<addrinfo, void (*)(addrinfo*)>;

Addresses resolve(const std::string& host, int port) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int problem = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
  if (problem != 0) throw Error("cannot listen on " + host + ": " + gai_strerror(problem));
  return {found, freeaddrinfo};
}

int port_of(int fd) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size);
  return ntohs(address.ss_family == AF_INET6 ? reinterpret_cast<sockaddr_in6&>(address).sin6_port
                                             : reinterpret_cast<sockaddr_in&>(address).sin_port);
}

}  // namespace

Listener::Listener(const std::string& host, int port) {
  constexpr int kBacklog = 1024;  // connections that are not accepted yet
  const Addresses addresses = resolve(host, port);
  int reason = 0;
  for (const addrinfo* a = addresses.get(); a; a = a->ai_next) {
    fd_ = socket(a->ai_family, a->ai_socktype | SOCK_CLOEXEC | SOCK_NONBLOCK, a->ai_protocol);
    if (fd_ < 0) continue;
    // SO_REUSEPORT is not set: a second server on the port must fail instead of taking half of the
    // connections.
    const int on = 1;
    setsockopt(fd_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (bind(fd_, a->ai_addr, a->ai_addrlen) == 0 && listen(fd_, kBacklog) == 0) {
      port_ = port_of(fd_);
      return;
    }
    reason = errno;
    close(fd_);
    fd_ = -1;
  }
  throw Error("cannot listen on " + host + " port " + std::to_string(port) + ": " + std::strerror(reason));
}

Listener::~Listener() { close(fd_); }

int Listener::accept() {
  const int fd = accept4(fd_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  out_of_room_ = fd < 0 && (errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM);
  if (fd < 0) return -1;
  const int on = 1;
  setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  // Limits the unsent bytes in the kernel. With a larger limit, a slow viewer would see every frame late
  // instead of skipping some.
  const int max_unsent = 128 * 1024;
  setsockopt(fd, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &max_unsent, sizeof max_unsent);
  return fd;
}

bool is_loopback(const std::string& host) {
  const Addresses addresses = resolve(host, 0);
  for (const addrinfo* a = addresses.get(); a; a = a->ai_next) {
    if (a->ai_family == AF_INET) {
      const auto address = ntohl(reinterpret_cast<const sockaddr_in*>(a->ai_addr)->sin_addr.s_addr);
      if (address >> 24 != 127) return false;
    } else if (a->ai_family != AF_INET6 ||
               !IN6_IS_ADDR_LOOPBACK(&reinterpret_cast<const sockaddr_in6*>(a->ai_addr)->sin6_addr)) {
      return false;
    }
  }
  return true;
}

}  // namespace orrery
