#include "server/commands/signals.h"

#include <poll.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <system_error>
#include <thread>

#include "server/commands/commands.h"

namespace orrery {

struct SignalWatch::Parts {
  sigset_t before{};
  int signals = -1, end = -1;
  std::stop_source interrupted;
  std::function<void()> on_first, on_hangup;
  std::thread thread;

  void watch() {
    for (;;) {
      pollfd ready[] = {{signals, POLLIN, 0}, {end, POLLIN, 0}};
      if (poll(ready, 2, -1) < 0) continue;
      if (ready[1].revents) return;
      signalfd_siginfo info;
      if (read(signals, &info, sizeof info) != sizeof info) continue;
      if (info.ssi_signo == SIGHUP) {
        on_hangup();
        continue;
      }
      if (!interrupted.request_stop()) _exit(kInterrupted);
      if (on_first) on_first();
    }
  }
};

SignalWatch::SignalWatch(std::function<void()> on_first, std::function<void()> on_hangup)
    : parts_(std::make_unique<Parts>()) {
  parts_->on_first = std::move(on_first);
  parts_->on_hangup = std::move(on_hangup);
  sigset_t taken;
  sigemptyset(&taken);
  sigaddset(&taken, SIGINT);
  sigaddset(&taken, SIGTERM);
  if (parts_->on_hangup) sigaddset(&taken, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &taken, &parts_->before);
  parts_->signals = signalfd(-1, &taken, SFD_CLOEXEC);
  parts_->end = eventfd(0, EFD_CLOEXEC);
  if (parts_->signals < 0 || parts_->end < 0)
    throw std::system_error(errno, std::generic_category(), "signalfd");
  parts_->thread = std::thread([parts = parts_.get()] { parts->watch(); });
}

SignalWatch::~SignalWatch() {
  eventfd_write(parts_->end, 1);
  parts_->thread.join();
  close(parts_->signals);
  close(parts_->end);
  pthread_sigmask(SIG_SETMASK, &parts_->before, nullptr);
}

std::stop_token SignalWatch::interrupted() const { return parts_->interrupted.get_token(); }

}  // namespace orrery
