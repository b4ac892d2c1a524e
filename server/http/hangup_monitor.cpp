#include "server/http/hangup_monitor.h"

#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <optional>
#include <system_error>

namespace orrery {
namespace {

constexpr std::uint64_t kEnd = 0;  // no socket's number: the monitor ends

void add(int epoll, int fd, std::uint32_t events, std::uint64_t number) {
  epoll_event event{.events = events, .data = {.u64 = number}};
  if (epoll_ctl(epoll, EPOLL_CTL_ADD, fd, &event) != 0)
    throw std::system_error(errno, std::generic_category(), "epoll_ctl");
}

}  // namespace

HangupMonitor::HangupMonitor() : epoll_(epoll_create1(EPOLL_CLOEXEC)), end_(eventfd(0, EFD_CLOEXEC)) {
  if (epoll_ < 0 || end_ < 0) throw std::system_error(errno, std::generic_category(), "epoll_create1");
  add(epoll_, end_, EPOLLIN, kEnd);
  thread_ = std::thread([this] { run(); });
}

HangupMonitor::~HangupMonitor() {
  eventfd_write(end_, 1);
  thread_.join();
  close(epoll_);
  close(end_);
}

HangupMonitor::Watching HangupMonitor::watch(int fd, std::stop_source work) {
  const std::lock_guard lock(mutex_);
  const std::uint64_t number = ++last_number_;
  // Numbers never return: an event that was on its way when its socket was forgotten finds nobody. Broken
  // connections are reported unasked.
  add(epoll_, fd, EPOLLRDHUP | EPOLLONESHOT, number);
  work_.emplace(number, std::move(work));
  return Watching(*this, fd, number);
}

void HangupMonitor::forget(int fd, std::uint64_t number) {
  const std::lock_guard lock(mutex_);
  epoll_ctl(epoll_, EPOLL_CTL_DEL, fd, nullptr);
  work_.erase(number);
}

void HangupMonitor::stop_work(std::uint64_t number) {
  std::optional<std::stop_source> work;
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = work_.find(number); found != work_.end()) work = found->second;
  }
  if (work) work->request_stop();
}

void HangupMonitor::run() {
  std::array<epoll_event, 64> events;
  for (;;) {
    const int count = epoll_wait(epoll_, events.data(), static_cast<int>(events.size()), -1);
    for (int i = 0; i < count; ++i) {
      const std::uint64_t number = events[static_cast<std::size_t>(i)].data.u64;
      if (number == kEnd) return;
      stop_work(number);
    }
  }
}

}  // namespace orrery
