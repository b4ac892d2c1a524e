#include "server/http/hangup_monitor.h"

#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

namespace orrery {
namespace {

constexpr std::uint64_t kEnd = 0;  // no socket's number: the monitor ends

void control(int epoll, int operation, int fd, std::uint32_t events, std::uint64_t number) {
  epoll_event event{.events = events, .data = {.u64 = number}};
  if (epoll_ctl(epoll, operation, fd, &event) != 0)
    throw std::system_error(errno, std::generic_category(), "epoll_ctl");
}

// False if it cannot be asked: then nothing can be sent to it any more.
bool ask(int fd) {
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

HangupMonitor::Watching HangupMonitor::watch(int fd, std::stop_source work, bool asks) {
  const std::lock_guard lock(mutex_);
  const std::uint64_t number = ++last_number_;
  // Numbers never return: an event that was on its way when its socket was forgotten finds nobody. Broken
  // connections are reported unasked.
  control(epoll_, EPOLL_CTL_ADD, fd, EPOLLRDHUP | EPOLLONESHOT, number);
  clients_.emplace(number, Client{fd, std::move(work), asks});
  return Watching(*this, fd, number);
}

void HangupMonitor::forget(int fd, std::uint64_t number) {
  const std::lock_guard lock(mutex_);
  epoll_ctl(epoll_, EPOLL_CTL_DEL, fd, nullptr);
  clients_.erase(number);
}

void HangupMonitor::stop_asking(std::uint64_t number) {
  const std::lock_guard lock(mutex_);
  clients_.at(number).asks = false;
}

void HangupMonitor::heed(std::uint64_t number, bool broken) {
  std::optional<std::stop_source> work;
  {
    const std::lock_guard lock(mutex_);
    const auto found = clients_.find(number);
    if (found == clients_.end()) return;
    Client& client = found->second;
    if (!broken && std::exchange(client.asks, false) && ask(client.fd))
      return control(epoll_, EPOLL_CTL_MOD, client.fd, EPOLLONESHOT, number);  // until it is broken
    work = client.work;
  }
  work->request_stop();
}

void HangupMonitor::run() {
  std::array<epoll_event, 64> events;
  for (;;) {
    const int count = epoll_wait(epoll_, events.data(), static_cast<int>(events.size()), -1);
    for (int i = 0; i < count; ++i) {
      const std::uint64_t number = events[static_cast<std::size_t>(i)].data.u64;
      if (number == kEnd) return;
      heed(number, events[static_cast<std::size_t>(i)].events & (EPOLLHUP | EPOLLERR));
    }
  }
}

}  // namespace orrery
