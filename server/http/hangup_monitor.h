#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <stop_token>
#include <thread>

#include "core/base/clock.h"

namespace orrery {

// Tells those who work for a client that it has gone: one thread waits for all sockets at once. Safe from any
// thread.
//
// Who sends no more may still wait for its answer, and looks just like who has closed its socket. It is asked
// by an interim response, "100 Continue", which every client of HTTP/1.1 skips (RFC 9110, 15.2): a closed
// socket answers that with a reset. It is asked several times, as a relay in between learns that its client
// has gone by the first, can send no more at the second, and is itself closed at the third.
class HangupMonitor {
 public:
  // Throws std::system_error if the system has no descriptors left.
  HangupMonitor();
  ~HangupMonitor();
  HangupMonitor(const HangupMonitor&) = delete;

  // A socket that is being watched, as long as this lives. The monitor and the socket must outlive it.
  class Watching {
   public:
    ~Watching() { monitor_.forget(fd_, number_); }
    Watching(const Watching&) = delete;

    // The answer begins: from now on who sends no more has gone.
    void stop_asking() { monitor_.stop_asking(number_); }

   private:
    friend class HangupMonitor;
    Watching(HangupMonitor& monitor, int fd, std::uint64_t number)
        : monitor_(monitor), fd_(fd), number_(number) {}
    HangupMonitor& monitor_;
    const int fd_;
    const std::uint64_t number_;
  };

  // Requests a stop of `work` on the monitor's thread once the client has closed its socket, or the
  // connection is broken; soon, if that is so already. What the stop calls must be short. A socket is watched
  // once at a time. asks: whether interim responses may be sent; who sends no more has gone, without.
  [[nodiscard]] Watching watch(int fd, std::stop_source work, bool asks);

 private:
  struct Client {
    int fd;
    std::stop_source work;
    int asks;  // that may still be sent
  };
  struct NextAsk {
    Clock::time_point at;
    std::uint64_t number;
  };

  void forget(int fd, std::uint64_t number);
  void stop_asking(std::uint64_t number);
  void run();
  void heed(std::uint64_t number, bool broken);
  void ask_again();
  int milliseconds_to_next_ask() const;
  // Asks the client, if it may be asked. False if it has gone.
  bool ask(Client& client, std::uint64_t number);

  const int epoll_, end_;
  std::mutex mutex_;
  std::uint64_t last_number_ = 0;            // guarded by mutex_
  std::map<std::uint64_t, Client> clients_;  // by number; guarded by mutex_
  std::deque<NextAsk> next_asks_;            // the next first; for thread_
  std::thread thread_;                       // last: it uses the others
};

}  // namespace orrery
