#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <stop_token>
#include <thread>

#include "core/base/clock.h"

namespace orrery {

// Cancels the work of clients that have disconnected. One thread watches all sockets. Thread-safe.
//
// A client that has shut down its sending side may still wait for its response, and looks like one that has
// closed its socket. The monitor probes it with interim responses, "100 Continue", which every HTTP/1.1
// client skips (RFC 9110, 15.2). A closed socket answers a probe with a reset. A TCP relay needs several
// probes. The first one makes the client's machine reset the relay's connection. The relay fails to forward
// the second one and has closed its socket when the third one arrives.
class HangupMonitor {
 public:
  // Throws std::system_error if no descriptors are left.
  HangupMonitor();
  ~HangupMonitor();
  HangupMonitor(const HangupMonitor&) = delete;

  // Registration of a watched socket, removed by the destructor. Monitor and socket must outlive it.
  class Registration {
   public:
    ~Registration() { monitor_.forget(fd_, number_); }
    Registration(const Registration&) = delete;

    // Ends probing when the response begins. From then on, a client that shuts down its sending side counts
    // as disconnected.
    void stop_probing() { monitor_.stop_probing(number_); }

   private:
    friend class HangupMonitor;
    Registration(HangupMonitor& monitor, int fd, std::uint64_t number)
        : monitor_(monitor), fd_(fd), number_(number) {}
    HangupMonitor& monitor_;
    const int fd_;
    const std::uint64_t number_;
  };

  // Requests a stop of `work` on the monitor's thread when the client closes its socket or the connection
  // breaks, even if that has already happened. Stop callbacks must be short. A socket must not have two
  // registrations at the same time. `probes_left`: whether to send probes. Without probes, a client that
  // shuts down its sending side counts as disconnected.
  [[nodiscard]] Registration watch(int fd, std::stop_source work, bool probes_left);

 private:
  struct Client {
    int fd;
    std::stop_source work;
    int probes_left;
  };
  struct NextProbe {
    Clock::time_point at;
    std::uint64_t number;
  };

  void forget(int fd, std::uint64_t number);
  void stop_probing(std::uint64_t number);
  void run();
  void handle_hangup(std::uint64_t number, bool broken);
  void send_due_probes();
  int milliseconds_to_next_probe() const;
  // Sends a probe and schedules the next one. Returns false if the client has disconnected.
  bool send_probe(Client& client, std::uint64_t number);

  const int epoll_, end_;
  std::mutex mutex_;
  std::uint64_t last_number_ = 0;            // guarded by mutex_
  std::map<std::uint64_t, Client> clients_;  // by number; guarded by mutex_
  std::deque<NextProbe> next_probes_;        // next first; used only by thread_
  std::thread thread_;                       // last: uses the other members
};

}  // namespace orrery
