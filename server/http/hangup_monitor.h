#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <stop_token>
#include <thread>

namespace orrery {

// Tells those who work for a client that it has gone: one thread waits for all sockets at once. Safe from any
// thread.
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

   private:
    friend class HangupMonitor;
    Watching(HangupMonitor& monitor, int fd, std::uint64_t number)
        : monitor_(monitor), fd_(fd), number_(number) {}
    HangupMonitor& monitor_;
    const int fd_;
    const std::uint64_t number_;
  };

  // Requests a stop of `work` on the monitor's thread once the client has closed its side of the socket, or
  // the connection is broken; soon, if that is so already. What the stop calls must be short. A socket is
  // watched once at a time.
  [[nodiscard]] Watching watch(int fd, std::stop_source work);

 private:
  void forget(int fd, std::uint64_t number);
  void run();
  void stop_work(std::uint64_t number);

  const int epoll_, end_;
  std::mutex mutex_;
  std::uint64_t last_number_ = 0;                   // guarded by mutex_
  std::map<std::uint64_t, std::stop_source> work_;  // by number; guarded by mutex_
  std::thread thread_;                              // last: it uses the others
};

}  // namespace orrery
