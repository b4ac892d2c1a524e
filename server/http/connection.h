#pragma once

#include <httplib.h>

#include <atomic>
#include <chrono>
#include <string>
#include <string_view>

#include "server/http/head.h"

namespace orrery {

// How long a client may take. The limits hold from the first byte of a request.
struct Patience {
  std::chrono::milliseconds idle{15'000};  // between two requests
  std::chrono::milliseconds head{5'000};   // for request line and headers
  std::chrono::milliseconds body_stall{10'000};
  std::size_t body_bytes_per_s = 1024;  // or better
  std::chrono::milliseconds write_stall{10'000};
};

// One client's socket as a stream for httplib. The stream yields only a request line of ours, because what
// the client sends is read and judged here, once: no second parser can understand it differently. Writing
// goes to the socket. For the thread that serves the connection, except gone() and abandon().
class Connection final : public httplib::Stream {
 public:
  // Takes the socket, which must not block. `wake` becomes readable when idle connections are to end.
  Connection(int fd, int wake, const Patience& patience);
  ~Connection() override;
  Connection(const Connection&) = delete;

  // Waits for the first byte of a request. False: there will be none.
  bool wait_for_request();
  // Reads up to the empty line. Throws HttpError.
  Head read_head();
  // What httplib will read as the next request.
  void offer(std::string request) { offered_ = std::move(request); }

  // Reads the body of the request with this head. Throws HttpError.
  std::string read_body(const Head& head, const Request::BodyLimit& limit);
  // Whether bytes of this request may still be under way; then nothing after it can be understood.
  bool body_unread() const { return body_left_ > 0; }

  bool gone() const;     // the client has closed its side, or the connection is broken
  void abandon() const;  // breaks it off, from any thread
  std::uint64_t bytes_written() const { return written_; }
  // The client's network: its IPv4 address, or the half of its IPv6 address that it does not choose itself.
  std::string network() const;

  bool is_readable() const override { return !offered_.empty(); }
  bool is_writable() const override { return !gone(); }
  ssize_t read(char* bytes, std::size_t size) override;
  ssize_t write(const char* bytes, std::size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  socket_t socket() const override { return fd_; }

 private:
  using Clock = std::chrono::steady_clock;

  // Appends what has come to `received_`, after waiting for it. False: the client has closed, or time is up.
  bool receive(Clock::time_point deadline);
  void drain();

  const int fd_, wake_;
  const Patience patience_;
  std::string received_;  // read from the socket, not used yet
  std::string offered_;   // for httplib
  std::size_t body_left_ = 0;
  bool fresh_ = true;  // no request was waited for yet
  std::uint64_t written_ = 0;
  mutable std::atomic<bool> broken_{false};
};

}  // namespace orrery
