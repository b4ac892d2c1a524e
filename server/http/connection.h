#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <initializer_list>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include "core/base/clock.h"
#include "server/http/head.h"
#include "server/http/network.h"
#include "server/scheduler/wait_state.h"

namespace orrery {

// Timeouts and minimum transfer rate of a connection. All but `idle` apply from the first byte of a request.
struct Timeouts {
  std::chrono::milliseconds idle{15'000};  // between two requests
  std::chrono::milliseconds head{5'000};   // for request line and headers
  // Minimum rate of bodies and responses in each `window`, at least size / `whole` if the size is known. A
  // body or response must end within `whole` + `window`.
  std::size_t bytes_per_s = 1024;
  std::chrono::seconds whole{600};
  std::chrono::seconds window{10};
  std::chrono::milliseconds shutdown_grace{1'000};  // for the remaining bytes of a request at shutdown
};

// Reads requests from a client's socket and writes responses. Only the thread that serves the connection may
// use it. shut_down(), client(), network(), waiting() and evict() are safe from any thread.
class Connection final {
 public:
  // Takes ownership of the socket, which must be non-blocking. `wake` becomes readable when shutdown begins.
  // Idle connections then close, and an incomplete request must arrive within `shutdown_grace`.
  Connection(int fd, const IpAddress& peer, int wake, const Timeouts& patience);
  ~Connection();
  Connection(const Connection&) = delete;

  // Waits for the first byte of a request. Skips up to 8 empty lines before it (RFC 9112, 2.2). Returns false
  // at the idle timeout, at the end of input, after eviction or at shutdown.
  bool wait_for_request();
  // Reads the request line and headers up to the empty line. Throws HttpError.
  Head read_head();

  // Reads the body of the request with this head. Calls `received` with the number of bytes received after
  // each read, and passes on its exceptions. Throws HttpError.
  using Received = std::function<void(std::size_t)>;
  std::string read_body(const Head& head, const BodyLimit& limit, const Received& received);
  // Whether bytes of this request may still arrive. If so, the connection cannot be reused.
  bool body_unread() const { return body_left_ > 0; }

  // Writes the pieces in order and blocks until the kernel has accepted all bytes. Returns false if the
  // client has disconnected or reads too slowly, and after eviction. REQUIRES: at most kMaxPieces pieces.
  static constexpr std::size_t kMaxPieces = 6;
  bool write(std::initializer_list<std::string_view> pieces);

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
  class MinimumRate;
  enum class Ready { socket, wake, none };

  // Waits until the socket is ready for `events` or broken. With `heed_wake`, also returns when shutdown
  // begins. Returns Ready::none at the deadline or after eviction.
  Ready wait(short events, Clock::time_point deadline, bool heed_wake);
  // Appends input to `received_`, and waits for it if necessary. Returns false at the end of input, at the
  // deadline, after eviction, or `shutdown_grace` after shutdown began.
  bool receive(Clock::time_point deadline);
  bool wait_to_receive(Clock::time_point deadline);
  std::string read_counted(std::size_t length, const Received& received);
  std::string read_chunks(const BodyLimit& limit, const Received& received);
  void receive_part(MinimumRate& pace);
  // Skips empty lines. Returns true if other input follows them.
  bool skip_empty_lines();
  // Returns the error for a `part` of a request that did not arrive in time.
  HttpError too_late(const std::string& part) const;
  // Moves `since` forward by the time that `bytes` take at the minimum rate, at most to the current time.
  void count_progress(Clock::time_point& since, std::size_t bytes) const;

  const int fd_, wake_;
  const IpAddress peer_;
  const std::string network_;
  const Timeouts patience_;
  std::string received_;  // input that is not consumed yet
  std::size_t body_left_ = 0;
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
