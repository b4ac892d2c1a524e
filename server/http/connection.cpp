#include "server/http/connection.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <limits>
#include <utility>

#include "core/base/shorten.h"
#include "server/http/framing_check.h"
#include "server/scheduler/handler_slots.h"

namespace orrery {
namespace {

using Clock = WaitState::Clock;

int milliseconds_until(Clock::time_point deadline) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, std::numeric_limits<int>::max()));
}

// Removes the first `bytes` bytes from the pieces of a message.
void take_from(msghdr& left, std::size_t bytes) {
  for (; left.msg_iovlen > 0 && bytes >= left.msg_iov->iov_len; ++left.msg_iov, --left.msg_iovlen)
    bytes -= left.msg_iov->iov_len;
  if (left.msg_iovlen == 0) return;
  left.msg_iov->iov_base = static_cast<char*>(left.msg_iov->iov_base) + bytes;
  left.msg_iov->iov_len -= bytes;
}

}  // namespace

Connection::Connection(int fd, const IpAddress& peer, int wake, const Timeouts& timeouts)
    : fd_(fd),
      wake_(wake),
      peer_(peer),
      network_(peer.network()),
      timeouts_(timeouts),
      reading_since_(Clock::now()),
      waiting_(POLLIN),
      client_(network_) {}

Connection::~Connection() {
  const ::linger at_once{.l_onoff = 1, .l_linger = 0};
  if (resets_on_close_)
    setsockopt(fd_, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  else
    shutdown(fd_, SHUT_RDWR);
  close(fd_);
}

void Connection::linger() {
  constexpr std::chrono::seconds kLinger{2};
  if (broken_ || is_evicted() || (body_left_ == 0 && received_.empty())) return;
  shutdown(fd_, SHUT_WR);
  reading_since_ = Clock::now();
  shutdown_deadline_.reset();
  const auto deadline = reading_since_ + kLinger;
  do received_.clear();
  while (Clock::now() < deadline && receive(deadline));
}

Connection::Ready Connection::wait(short events, Clock::time_point deadline, bool heed_wake) {
  if (!waiting_.begin(events == POLLOUT ? *writing_since_ : reading_since_, events)) return Ready::none;
  const HandlerSlots::Wait released(WaitState::Kind::client);
  pollfd ready[] = {{fd_, events, 0}, {wake_, POLLIN, 0}};
  int count;
  do count = poll(ready, heed_wake ? 2 : 1, milliseconds_until(deadline));
  while (count < 0 && errno == EINTR);
  if (!waiting_.end() || count <= 0) return Ready::none;
  return ready[0].revents != 0 ? Ready::socket : Ready::wake;
}

std::stop_source Connection::begin_request(const std::string& client) {
  const std::lock_guard lock(mutex_);
  client_ = client;
  return request_ = std::stop_source();
}

std::string Connection::client() const {
  const std::lock_guard lock(mutex_);
  return client_;
}

bool Connection::evict(WaitState::Kind kind) {
  pollfd ready{fd_, waiting_.events(), 0};
  const bool goes_on = kind == WaitState::Kind::client && poll(&ready, 1, 0) > 0;
  if (goes_on || !waiting_.evict(kind)) return false;
  if (kind == WaitState::Kind::client)  // a client that sends too slowly can still receive a 408
    shutdown(fd_, waiting_.events() == POLLIN ? SHUT_RD : SHUT_RDWR);
  std::stop_source request;
  {
    const std::lock_guard lock(mutex_);
    request = request_;
  }
  request.request_stop();
  return true;
}

bool Connection::skip_empty_lines() {
  constexpr int kMost = 8;  // further empty lines are parsed as the request and rejected
  while (empty_lines_ < kMost && received_.starts_with("\r\n")) {
    received_.erase(0, 2);
    ++empty_lines_;
  }
  return !received_.empty() && received_ != "\r";
}

bool Connection::wait_for_request() {
  // Time for the first request of a connection to arrive after shutdown begins.
  constexpr std::chrono::milliseconds kFirstRequestGrace{200};
  bool fresh = std::exchange(fresh_, false);
  reading_since_ = Clock::now();
  writing_since_.reset();
  auto deadline = reading_since_ + timeouts_.idle;
  while (!skip_empty_lines()) {
    // A request that has already arrived is answered even during shutdown.
    const Ready ready = wait(POLLIN, deadline, true);
    if (ready == Ready::none) return false;
    if (ready == Ready::wake) {
      if (!std::exchange(fresh, false)) return false;
      deadline = Clock::now() + kFirstRequestGrace;
    }
    if (!receive(deadline)) return false;
  }
  return true;
}

bool Connection::receive(Clock::time_point deadline) {
  std::array<char, 64 * 1024> bytes;
  while (!is_evicted()) {
    const ssize_t count = recv(fd_, bytes.data(), bytes.size(), 0);
    if (count > 0) {
      received_.append(bytes.data(), static_cast<std::size_t>(count));
      return true;
    }
    if (count == 0) ended_ = true;
    if (count == 0) return false;
    if (errno != EINTR && errno != EAGAIN) {
      broken_ = true;
      return false;
    }
    if (errno == EAGAIN && !wait_to_receive(deadline)) return false;
  }
  return false;
}

bool Connection::wait_to_receive(Clock::time_point deadline) {
  if (!shutdown_deadline_) {
    const Ready ready = wait(POLLIN, deadline, true);
    if (ready != Ready::wake) return ready == Ready::socket;
    shutdown_deadline_ = Clock::now() + timeouts_.shutdown_grace;
  }
  return wait(POLLIN, std::min(deadline, *shutdown_deadline_), false) == Ready::socket;
}

HttpError Connection::too_late(const std::string& part) const {
  if (is_evicted())
    return {408, part + " arrived too slowly while the limit on connections was reached (connections)"};
  if (shutdown_deadline_)
    return {503, part + " did not arrive before the service shut down", {{"Retry-After", "1"}}};
  return {408, part + " did not arrive in time"};
}

void Connection::count_progress(Clock::time_point& since, std::size_t bytes) const {
  const auto earned = std::chrono::microseconds(bytes * 1'000'000 / timeouts_.bytes_per_s);
  since = std::min(Clock::now(), since + earned);
}

void Connection::read_head() {
  constexpr std::string_view kEnd = "\r\n\r\n";
  const auto deadline = Clock::now() + timeouts_.head;
  const auto receive_more = [&] {
    if (!receive(deadline)) throw too_late("request headers");
  };
  ready_.clear();
  read_ = 0;
  chunks_.reset();
  rate_.reset();
  while (!skip_empty_lines()) receive_more();
  std::size_t searched = 0, screened = 0;
  for (;;) {
    const std::size_t end = received_.find(kEnd, searched);
    const std::size_t size = end == std::string::npos ? received_.size() : end + kEnd.size();
    screen_head(std::string_view(received_).substr(0, std::min(size, kMaxHeadBytes)), screened);
    screened = size;
    if (size > kMaxHeadBytes)
      throw HttpError(431, "request headers have more than " + grouped(kMaxHeadBytes) + " bytes (limit " +
                               grouped(kMaxHeadBytes) + ", head_bytes)");
    if (end != std::string::npos) return take_head(size);
    searched = received_.size() - std::min(received_.size(), kEnd.size() - 1);
    receive_more();
  }
}

void Connection::take_head(std::size_t size) {
  const std::string bytes = received_.substr(0, size);
  received_.erase(0, size);
  empty_lines_ = 0;
  CheckedHead head = check_head(bytes);
  ready_ = std::move(head.bytes);
  chunked_ = head.chunked;
  content_length_ = head.content_length;
  body_left_ = chunked_ ? std::numeric_limits<std::size_t>::max() : content_length_.value_or(0);
}

void Connection::begin_body(const BodyLimit& limit) {
  if (!chunked_ && !content_length_) {
    body_left_ = std::numeric_limits<std::size_t>::max();  // all further input belongs to the body
    throw HttpError(411, "request body must have a Content-Length or chunked Transfer-Encoding");
  }
  if (content_length_.value_or(0) > limit.bytes) throw body_too_long(limit, grouped(*content_length_));
  if (chunked_) chunks_.emplace(limit);
  reading_since_ = Clock::now();
  rate_.emplace(content_length_.value_or(0), timeouts_);
}

ssize_t Connection::read(char* to, std::size_t size) {
  try {
    if (read_ == ready_.size()) receive_body();
  } catch (const HttpError&) {
    read_error_ = std::current_exception();
    return -1;
  }
  const std::size_t count = std::min(size, ready_.size() - read_);
  std::copy_n(ready_.data() + read_, count, to);
  read_ += count;
  return static_cast<ssize_t>(count);
}

void Connection::rethrow_read_error() const {
  if (read_error_) std::rethrow_exception(read_error_);
  throw HttpError(400, "malformed request body");
}

void Connection::receive_body() {
  ready_.clear();
  read_ = 0;
  while (rate_ && body_left_ > 0 && ready_.empty()) {
    if (chunks_) {
      chunks_->pass_on(received_, ready_);
      if (chunks_->has_ended()) body_left_ = 0;
    } else if (received_.size() <= body_left_) {
      ready_.swap(received_);
      body_left_ -= ready_.size();
    } else {
      ready_ = received_.substr(0, body_left_);
      received_.erase(0, body_left_);
      body_left_ = 0;
    }
    if (body_left_ > 0 && ready_.empty()) receive_part();
  }
}

void Connection::receive_part() {
  flush();  // sends a 100 Continue, for which the client may wait
  const std::size_t before = received_.size();
  if (!receive(rate_->deadline())) throw too_late("request body");
  rate_->count(received_.size() - before);
  count_progress(reading_since_, received_.size() - before);
}

void Connection::shut_down() const {
  broken_ = true;
  shutdown(fd_, SHUT_RDWR);
}

ssize_t Connection::write(const char* bytes, std::size_t size) {
  constexpr std::size_t kSmall = 8 * 1024;
  if (unsent_.size() + size <= kSmall) {
    unsent_.append(bytes, size);
    return broken_ ? -1 : static_cast<ssize_t>(size);
  }
  const bool sent = send_all({unsent_, {bytes, size}});
  unsent_.clear();
  return sent ? static_cast<ssize_t>(size) : -1;
}

bool Connection::flush() {
  const bool sent = send_all({unsent_});
  unsent_.clear();
  return sent;
}

void Connection::get_remote_ip_and_port(std::string& ip, int& port) const {
  ip = network_;
  port = 0;
}

void Connection::get_local_ip_and_port(std::string& ip, int& port) const {
  ip.clear();
  port = 0;
}

bool Connection::send_all(std::initializer_list<std::string_view> pieces) {
  assert(pieces.size() <= kMaxPieces);
  std::array<iovec, kMaxPieces> vectors;
  msghdr left{};  // unsent bytes
  left.msg_iov = vectors.data();
  std::size_t size = 0;
  for (const std::string_view piece : pieces) {
    if (!piece.empty()) vectors[left.msg_iovlen++] = {const_cast<char*>(piece.data()), piece.size()};
    size += piece.size();
  }
  MinimumRate rate(size, timeouts_);
  while (left.msg_iovlen > 0 && !broken_) {
    const ssize_t count = sendmsg(fd_, &left, MSG_NOSIGNAL);
    if (count >= 0) {
      take_from(left, static_cast<std::size_t>(count));
      written_ += static_cast<std::uint64_t>(count);
      if (writing_since_) count_progress(*writing_since_, static_cast<std::size_t>(count));
      rate.count(static_cast<std::size_t>(count));
      continue;
    }
    if (errno == EAGAIN && !writing_since_) writing_since_ = Clock::now();
    if (errno == EINTR || (errno == EAGAIN && wait(POLLOUT, rate.deadline(), false) == Ready::socket))
      continue;
    broken_ = true;
  }
  return !broken_;
}

}  // namespace orrery
