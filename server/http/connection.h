#pragma once

#include <httplib.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <initializer_list>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include "core/base/clock.h"
#include "server/http/chunk_check.h"
#include "server/http/minimum_rate.h"
#include "server/http/network.h"
#include "server/scheduler/wait_state.h"

namespace orrery {

// Socket of a client as a stream of cpp-httplib, with timeouts, minimum rates and eviction. Only the thread
// that serves the connection may use it. shut_down(), client(), network(), waiting() and evict() are safe
// from any thread.
class Connection final : public httplib::Stream {
 public:
  // Takes ownership of the socket, which must be non-blocking. `wake` becomes readable when shutdown begins.
  // Idle connections then close, and an incomplete request must arrive within `shutdown_grace`.
  Connection(int fd, const IpAddress& peer, int wake, const Timeouts& timeouts);
  ~Connection() override;
  Connection(const Connection&) = delete;

  // Waits for the first byte of a request. Skips up to 8 empty lines before it (RFC 9112, 2.2). Returns false
  // at the idle timeout, at the end of input, after eviction or at shutdown.
  bool wait_for_request();
  // Receives the request line and headers and checks them. read() then returns them. Throws HttpError.
  void read_head();
  // Lets read() return the body. Throws HttpError 411 or 413 if its length is missing or over the limit.
  // REQUIRES: read_head() has returned.
  void begin_body(const BodyLimit& limit);
  // Whether bytes of this request may still arrive. If so, the connection cannot be reused.
  bool body_unread() const { return body_left_ > 0; }
  // Whether bytes after the head have arrived.
  bool has_received_more() const { return !received_.empty(); }

  // Returns the next bytes of the head and, after begin_body(), of the body: 0 at the end, -1 after an error
  // that rethrow_read_error() throws.
  ssize_t read(char* to, std::size_t size) override;
  // Throws HttpError, the cause of the last -1 of read().
  [[noreturn]] void rethrow_read_error() const;

  // Buffers small pieces. Blocks until the kernel has accepted larger ones, with all bytes before them.
  // Returns `size`, or -1 if the client has disconnected or reads too slowly, and after eviction.
  ssize_t write(const char* bytes, std::size_t size) override;
  // Writes the buffered bytes. Returns false where write() returns -1.
  bool flush();

  // cpp-httplib calls these functions before it reads or writes. They never wait: read() and write() do.
  bool is_readable() const override { return true; }
  bool is_writable() const override { return !broken_; }
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  // cpp-httplib rejects sockets of 1024 and more because it may call select(). This stream calls poll().
  socket_t socket() const override { return 0; }

  // Shuts down sending and discards unread request bytes for up to 2 s before the connection closes. If the
  // client is still sending, an immediate close would reset the connection and the response would be lost.
  void linger();

  int fd() const { return fd_; }
  bool is_disconnected() const { return broken_ || ended_; }  // the client has stopped sending or receiving
  void shut_down() const;                                     // shuts down both directions of the socket
  // Makes the destructor reset the connection. A normal close would mark a truncated HTTP/1.0 body as
  // complete.
  void reset_on_close() { resets_on_close_ = true; }

  // Begins a request of `client`. Returns its stop source, on which evict() requests a stop.
  std::stop_source begin_request(const std::string& client);
  // Returns the client of the latest request, or the network of the peer before the first request.
  std::string client() const;

  // Wait state of the connection's thread. Each byte transferred moves the start of the wait forward, so that
  // the wait of a client at the minimum rate never grows.
  WaitState& waiting() { return waiting_; }
  // Evicts the connection, which its thread then soon ends. Returns false if the thread no longer waits for
  // `kind`, or waits for a client whose socket is ready.
  bool evict(WaitState::Kind kind);
  bool is_evicted() const { return waiting_.was_evicted(); }

  std::uint64_t bytes_written() const { return written_; }
  const IpAddress& peer() const { return peer_; }
  const std::string& network() const { return network_; }  // network of the peer

 private:
  using Clock = WaitState::Clock;
  enum class Ready { socket, wake, none };

  // Waits until the socket is ready for `events` or broken. With `heed_wake`, also returns when shutdown
  // begins. Returns Ready::none at the deadline or after eviction.
  Ready wait(short events, Clock::time_point deadline, bool heed_wake);
  // Appends input to `received_`, and waits for it if necessary. Returns false at the end of input, at the
  // deadline, after eviction, or `shutdown_grace` after shutdown began.
  bool receive(Clock::time_point deadline);
  bool wait_to_receive(Clock::time_point deadline);
  // Receives body bytes into `ready_`, if the body has not ended. Throws HttpError.
  void receive_body();
  void take_head(std::size_t size);  // checks the first `size` bytes of `received_`
  void receive_part();
  // Writes the pieces in order and blocks until the kernel has accepted all bytes. Returns false as write()
  // returns -1. REQUIRES: at most kMaxPieces pieces.
  static constexpr std::size_t kMaxPieces = 2;
  bool send_all(std::initializer_list<std::string_view> pieces);
  // Skips empty lines. Returns true if other input follows them.
  bool skip_empty_lines();
  // Returns the error for a `part` of a request that did not arrive in time.
  HttpError too_late(const std::string& part) const;
  // Moves `since` forward by the time that `bytes` take at the minimum rate, at most to the current time.
  void count_progress(Clock::time_point& since, std::size_t bytes) const;

  const int fd_, wake_;
  const IpAddress peer_;
  const std::string network_;
  const Timeouts timeouts_;
  std::string received_;       // input that is not consumed yet
  std::string ready_;          // checked bytes for read()
  std::size_t read_ = 0;       // bytes of `ready_` that read() has returned
  std::string unsent_;         // bytes of write() that wait for flush()
  std::size_t body_left_ = 0;  // bytes of a body that may still arrive; maximum if unknown
  bool chunked_ = false;       // the body is chunked
  std::optional<std::size_t> content_length_;
  std::optional<ChunkCheck> chunks_;  // set while a chunked body is read
  std::optional<MinimumRate> rate_;   // set while a body is read
  std::exception_ptr read_error_;
  int empty_lines_ = 0;  // skipped before the current request
  bool fresh_ = true;    // until the first wait_for_request()
  std::uint64_t written_ = 0;
  Clock::time_point reading_since_;                     // start of the wait for input, see waiting()
  std::optional<Clock::time_point> writing_since_;      // time of the first blocked write of the response
  std::optional<Clock::time_point> shutdown_deadline_;  // deadline for input after shutdown began
  WaitState waiting_;
  mutable std::mutex mutex_;
  std::string client_;        // guarded by mutex_
  std::stop_source request_;  // guarded by mutex_
  bool ended_ = false;        // the client has shut down its sending side
  bool resets_on_close_ = false;
  mutable std::atomic<bool> broken_{false};
};

}  // namespace orrery
