#include "server/http/shed.h"

#include <sys/socket.h>
#include <unistd.h>

#include <string>

namespace orrery {
namespace {

std::string answer() {
  const std::string body =
      R"~({"type":"about:blank","title":"Service Unavailable","status":503,"detail":"Too many connections (connections)"})~";
  return "HTTP/1.1 503 Service Unavailable\r\nContent-Type: application/problem+json\r\nRetry-After: 1\r\n"
         "Connection: close\r\nContent-Length: " +
         std::to_string(body.size()) + "\r\n\r\n" + body;
}

}  // namespace

Shed::~Shed() {
  for (const Refused& refused : refused_) close(refused.fd);
}

void Shed::refuse(int fd) {
  constexpr std::size_t kMost = 256;  // sockets kept open for clients that still send
  const std::string bytes = answer();
  [[maybe_unused]] const ssize_t sent = send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  shutdown(fd, SHUT_WR);
  refused_.push_back({fd, std::chrono::steady_clock::now()});
  if (refused_.size() <= kMost) return;
  close(refused_.front().fd);
  refused_.pop_front();
}

void Shed::close_old() {
  const auto now = std::chrono::steady_clock::now();
  while (!refused_.empty() && now - refused_.front().since > std::chrono::seconds(1)) {
    close(refused_.front().fd);
    refused_.pop_front();
  }
}

}  // namespace orrery
