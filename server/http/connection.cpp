#include "server/http/connection.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <limits>
#include <utility>

namespace orrery {
namespace {

using Clock = std::chrono::steady_clock;

int milliseconds_until(Clock::time_point deadline) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, std::numeric_limits<int>::max()));
}

// Waits until the socket is ready for `events` or broken. False: time is up.
bool wait_for(int fd, short events, Clock::time_point deadline) {
  for (;;) {
    pollfd ready{fd, events, 0};
    const int count = poll(&ready, 1, milliseconds_until(deadline));
    if (count > 0) return true;
    if (count == 0 || errno != EINTR) return false;
  }
}

}  // namespace

Connection::Connection(int fd, int wake, const Patience& patience)
    : fd_(fd), wake_(wake), patience_(patience) {}

Connection::~Connection() {
  // Closing while the client still sends would make it see a broken connection instead of the answer.
  if (body_left_ > 0 || !received_.empty()) drain();
  shutdown(fd_, SHUT_RDWR);
  close(fd_);
}

void Connection::drain() {
  constexpr std::chrono::seconds kLinger{2};
  shutdown(fd_, SHUT_WR);
  const auto deadline = Clock::now() + kLinger;
  do received_.clear();
  while (Clock::now() < deadline && receive(deadline));
}

bool Connection::wait_for_request() {
  constexpr std::chrono::milliseconds kLastCall{200};  // for who has connected, but not said anything yet
  const bool fresh = std::exchange(fresh_, false);
  if (!received_.empty()) return true;
  pollfd ready[] = {{fd_, POLLIN, 0}, {wake_, POLLIN, 0}};
  const auto deadline = Clock::now() + patience_.idle;
  while (poll(ready, 2, milliseconds_until(deadline)) < 0)
    if (errno != EINTR) return false;
  // A request that is here already is answered even if idle connections are to end.
  if (ready[0].revents != 0) return receive(deadline);
  return ready[1].revents != 0 && fresh && receive(Clock::now() + kLastCall);
}

bool Connection::receive(Clock::time_point deadline) {
  std::array<char, 64 * 1024> bytes;
  for (;;) {
    const ssize_t count = recv(fd_, bytes.data(), bytes.size(), 0);
    if (count > 0) {
      received_.append(bytes.data(), static_cast<std::size_t>(count));
      return true;
    }
    if (count == 0) return false;
    if (errno != EINTR && errno != EAGAIN) {
      broken_ = true;
      return false;
    }
    if (errno == EAGAIN && !wait_for(fd_, POLLIN, deadline)) return false;
  }
}

Head Connection::read_head() {
  constexpr std::string_view kEnd = "\r\n\r\n";
  const auto deadline = Clock::now() + patience_.head;
  std::size_t searched = 0;
  for (;;) {
    const std::size_t end = received_.find(kEnd, searched);
    if (std::min(end, received_.size()) + kEnd.size() > kMaxHeadBytes)
      throw HttpError(431,
                      "The request's headers have more than " + std::to_string(kMaxHeadBytes) + " bytes");
    if (end != std::string::npos) {
      const std::string bytes = received_.substr(0, end + kEnd.size());
      received_.erase(0, bytes.size());
      Head head = parse_head(bytes);
      // A chunked body is refused unread, so all that follows is lost.
      body_left_ = head.chunked ? std::numeric_limits<std::size_t>::max() : head.content_length.value_or(0);
      return head;
    }
    searched = received_.size() - std::min(received_.size(), kEnd.size() - 1);
    if (!receive(deadline)) throw HttpError(408, "The request's headers did not come in time");
  }
}

std::string Connection::read_body(const Head& head, const Request::BodyLimit& limit) {
  if (head.chunked || !head.content_length) throw HttpError(411, "A body must come with its Content-Length");
  const std::size_t length = *head.content_length;
  if (length > limit.bytes)
    throw HttpError(413, "The body has " + std::to_string(length) + " bytes, at most " +
                             std::to_string(limit.bytes) + " are allowed (" + limit.name + ")");
  if (const auto expect = head.header("Expect")) {
    if (!equal_ignoring_case(*expect, "100-continue"))
      throw HttpError(417, "Expected no Expect but 100-continue");
    if (received_.empty() && length > 0) httplib::Stream::write(std::string("HTTP/1.1 100 Continue\r\n\r\n"));
  }
  const auto deadline =
      Clock::now() + patience_.body_stall + std::chrono::seconds(length / patience_.body_bytes_per_s);
  received_.reserve(std::min<std::size_t>(length, 1 << 20));
  while (received_.size() < length) {
    if (!receive(std::min(deadline, Clock::now() + patience_.body_stall)))
      throw HttpError(408, "The body did not come in time");
  }
  std::string body = received_.substr(0, length);
  received_.erase(0, length);
  body_left_ = 0;
  return body;
}

bool Connection::gone() const {
  if (broken_) return true;
  pollfd ready{fd_, POLLRDHUP, 0};
  if (poll(&ready, 1, 0) > 0 && (ready.revents & (POLLRDHUP | POLLHUP | POLLERR))) broken_ = true;
  return broken_;
}

void Connection::abandon() const {
  broken_ = true;
  shutdown(fd_, SHUT_RDWR);
}

ssize_t Connection::read(char* bytes, std::size_t size) {
  const std::size_t count = offered_.copy(bytes, size);
  offered_.erase(0, count);
  return static_cast<ssize_t>(count);
}

ssize_t Connection::write(const char* bytes, std::size_t size) {
  const auto deadline = Clock::now() + patience_.write_stall;
  while (!broken_) {
    const ssize_t count = send(fd_, bytes, size, MSG_NOSIGNAL);
    if (count >= 0) {
      written_ += static_cast<std::uint64_t>(count);
      return count;
    }
    if (errno == EINTR || (errno == EAGAIN && wait_for(fd_, POLLOUT, deadline))) continue;
    broken_ = true;
  }
  return -1;
}

std::string Connection::network() const {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (getpeername(fd_, reinterpret_cast<sockaddr*>(&address), &size) != 0) return "";
  std::array<char, INET6_ADDRSTRLEN> text{};
  const void* bytes = &reinterpret_cast<sockaddr_in&>(address).sin_addr;
  if (address.ss_family == AF_INET6) {
    in6_addr& v6 = reinterpret_cast<sockaddr_in6&>(address).sin6_addr;
    if (!IN6_IS_ADDR_V4MAPPED(&v6)) std::fill(v6.s6_addr + 8, v6.s6_addr + 16, std::uint8_t{0});
    bytes = &v6;
  }
  inet_ntop(address.ss_family, bytes, text.data(), text.size());
  return text.data();
}

void Connection::get_remote_ip_and_port(std::string& ip, int& port) const {
  ip.clear();
  port = -1;
}

void Connection::get_local_ip_and_port(std::string& ip, int& port) const { get_remote_ip_and_port(ip, port); }

}  // namespace orrery
