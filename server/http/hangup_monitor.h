#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <stop_token>
#include <thread>

#include "core/base/clock.h"

namespace orrery {

// Cancels work whose client has disconnected. One thread watches all sockets. Thread-safe.
//
// A client that has shut down its sending side may still wait for its response, and looks like one that has
// closed its socket. The monitor probes it with interim responses, "100 Continue", which every HTTP/1.1
// client skips (RFC 9110, 15.2). A closed socket answers a probe with a reset. A relay needs several probes:
// it learns from the first that its client has closed, cannot send the second, and is closed at the third.
class HangupMonitor {
 public:
  // Throws std::system_error if no descriptors are left.
  HangupMonitor();
  ~HangupMonitor();
  HangupMonitor(const HangupMonitor&) = delete;

  // Registration of a watched socket, removed by the destructor. Monitor and socket must outlive it.
  class Watching {
   public:
    ~Watching() { monitor_.forget(fd_, number_); }
    Watching(const Watching&) = delete;

    // Ends probing, since the response begins. A client that then shuts down its sending side has
    // disconnected.
    void stop_asking() { monitor_.stop_asking(number_); }

   private:
    friend class HangupMonitor;
    Watching(HangupMonitor& monitor, int fd, std::uint64_t number)
        : monitor_(monitor), fd_(fd), number_(number) {}
    HangupMonitor& monitor_;
    const int fd_;
    const std::uint64_t number_;
  };

  // Requests a stop of `work` on the monitor's thread when the client closes its socket or the connection
  // breaks, even if that has already happened. Stop callbacks must be short. A socket may be watched once at
  // a time. `asks`: whether to send probes. Without probes, a client that shuts down its sending side counts
  // as disconnected.
  [[nodiscard]] Watching watch(int fd, std::stop_source work, bool asks);

 private:
  struct Client {
    int fd;
    std::stop_source work;
    int asks;  // probes left
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
  // Sends a probe and schedules the next one. Returns false if the client has disconnected.
  bool ask(Client& client, std::uint64_t number);

  const int epoll_, end_;
  std::mutex mutex_;
  std::uint64_t last_number_ = 0;            // guarded by mutex_
  std::map<std::uint64_t, Client> clients_;  // by number; guarded by mutex_
  std::deque<NextAsk> next_asks_;            // next first; for thread_
  std::thread thread_;                       // last: uses the other members
};

}  // namespace orrery
