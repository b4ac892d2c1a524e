#include "server/http/overload_responder.h"

#include <sys/socket.h>
#include <unistd.h>

namespace orrery {

OverloadResponder::~OverloadResponder() {
  for (const Refused& refused : refused_) close(refused.fd);
}

void OverloadResponder::refuse(int fd, std::string_view bytes) {
  constexpr std::chrono::seconds kTimeToRead{1};
  [[maybe_unused]] const ssize_t sent = send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  shutdown(fd, SHUT_WR);
  refused_.push_back({fd, std::chrono::steady_clock::now() + kTimeToRead});
  if (refused_.size() <= kMost) return;
  close(refused_.front().fd);
  refused_.pop_front();
}

void OverloadResponder::close_old() {
  const auto now = std::chrono::steady_clock::now();
  while (!refused_.empty() && now >= refused_.front().close_at) {
    close(refused_.front().fd);
    refused_.pop_front();
  }
}

std::chrono::steady_clock::time_point OverloadResponder::next_close() const {
  return refused_.empty() ? std::chrono::steady_clock::time_point::max() : refused_.front().close_at;
}

}  // namespace orrery
