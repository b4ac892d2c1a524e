#include "server/http/hangup_monitor.h"

#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>
#include <string_view>
#include <system_error>

namespace orrery {
namespace {

constexpr std::uint64_t kEnd = 0;  // number of end_; sockets are numbered from 1

void control(int epoll, int operation, int fd, std::uint32_t events, std::uint64_t number) {
  epoll_event event{.events = events, .data = {.u64 = number}};
  if (epoll_ctl(epoll, operation, fd, &event) != 0)
    throw std::system_error(errno, std::generic_category(), "epoll_ctl");
}

constexpr int kProbes = 4;
constexpr std::chrono::milliseconds kProbeInterval{50};

// Sends a probe. Returns false if the socket is broken or its send buffer is full.
bool send_interim(int fd) {
  constexpr std::string_view kInterim = "HTTP/1.1 100 Continue\r\n\r\n";
  const ssize_t sent = send(fd, kInterim.data(), kInterim.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  const bool whole = sent == static_cast<ssize_t>(kInterim.size());
  if (sent > 0 && !whole) shutdown(fd, SHUT_RDWR);
  return whole;
}

}  // namespace

HangupMonitor::HangupMonitor() : epoll_(epoll_create1(EPOLL_CLOEXEC)), end_(eventfd(0, EFD_CLOEXEC)) {
  if (epoll_ < 0 || end_ < 0) throw std::system_error(errno, std::generic_category(), "epoll_create1");
  control(epoll_, EPOLL_CTL_ADD, end_, EPOLLIN, kEnd);
  thread_ = std::thread([this] { run(); });
}

HangupMonitor::~HangupMonitor() {
  eventfd_write(end_, 1);
  thread_.join();
  close(epoll_);
  close(end_);
}

HangupMonitor::Registration HangupMonitor::watch(int fd, std::stop_source work, bool probes_left) {
  const std::lock_guard lock(mutex_);
  const std::uint64_t number = ++last_number_;
  // Numbers are never reused, so a late event for a forgotten socket finds no client. epoll reports broken
  // connections even without a flag for them.
  control(epoll_, EPOLL_CTL_ADD, fd, EPOLLRDHUP | EPOLLONESHOT, number);
  clients_.emplace(number, Client{fd, std::move(work), probes_left ? kProbes : 0});
  return Registration(*this, fd, number);
}

void HangupMonitor::forget(int fd, std::uint64_t number) {
  const std::lock_guard lock(mutex_);
  epoll_ctl(epoll_, EPOLL_CTL_DEL, fd, nullptr);
  clients_.erase(number);
}

void HangupMonitor::stop_probing(std::uint64_t number) {
  const std::lock_guard lock(mutex_);
  clients_.at(number).probes_left = 0;
}

void HangupMonitor::handle_hangup(std::uint64_t number, bool broken) {
  std::optional<std::stop_source> work;
  {
    const std::lock_guard lock(mutex_);
    const auto found = clients_.find(number);
    if (found == clients_.end()) return;
    Client& client = found->second;
    if (!broken && client.probes_left > 0 && send_probe(client, number))
      return control(epoll_, EPOLL_CTL_MOD, client.fd, EPOLLONESHOT, number);  // HUP and ERR only
    work = client.work;
  }
  work->request_stop();
}

bool HangupMonitor::send_probe(Client& client, std::uint64_t number) {
  if (!send_interim(client.fd)) return false;
  if (--client.probes_left > 0) next_probes_.push_back({Clock::now() + kProbeInterval, number});
  return true;
}

void HangupMonitor::send_due_probes() {
  while (!next_probes_.empty() && next_probes_.front().at <= Clock::now()) {
    const std::uint64_t number = next_probes_.front().number;
    next_probes_.pop_front();
    std::optional<std::stop_source> work;
    {
      const std::lock_guard lock(mutex_);
      const auto found = clients_.find(number);
      if (found == clients_.end() || found->second.probes_left == 0 || send_probe(found->second, number))
        continue;
      work = found->second.work;
    }
    work->request_stop();
  }
}

int HangupMonitor::milliseconds_to_next_probe() const {
  if (next_probes_.empty()) return -1;
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(next_probes_.front().at - Clock::now());
  return static_cast<int>(std::max<std::int64_t>(left.count(), 0));
}

void HangupMonitor::run() {
  std::array<epoll_event, 64> events;
  for (;;) {
    const int count =
        epoll_wait(epoll_, events.data(), static_cast<int>(events.size()), milliseconds_to_next_probe());
    for (int i = 0; i < count; ++i) {
      const std::uint64_t number = events[static_cast<std::size_t>(i)].data.u64;
      if (number == kEnd) return;
      handle_hangup(number, events[static_cast<std::size_t>(i)].events & (EPOLLHUP | EPOLLERR));
    }
    send_due_probes();
  }
}

}  // namespace orrery
