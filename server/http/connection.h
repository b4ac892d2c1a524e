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
#include "server/http/wait_state.h"

namespace orrery {

// Timeouts and minimum rate for clients. All but `idle` apply from the first byte of a request.
struct Timeouts {
  std::chrono::milliseconds idle{15'000};  // between two requests
  std::chrono::milliseconds head{5'000};   // for request line and headers
  // Minimum rate of bodies and responses in each `window`. A message of known size also needs size / `whole`.
  std::size_t bytes_per_s = 1024;
  std::chrono::seconds whole{600};
  std::chrono::seconds window{10};
  std::chrono::milliseconds shutdown_grace{1'000};  // for the rest of a request after shutdown begins
};

// A client's socket: reads requests and writes responses. For the thread that serves the connection, except
// shut_down(), client(), waiting() and evict().
class Connection final {
 public:
  // Takes ownership of the socket, which must be non-blocking. `wake` becomes readable when shutdown begins.
  // Idle connections then close, and an incomplete request has `shutdown_grace` to arrive.
  Connection(int fd, const IpAddress& peer, int wake, const Timeouts& patience);
  ~Connection();
  Connection(const Connection&) = delete;

  // Waits for the first byte of a request. Skips up to 8 empty lines before it (RFC 9112, 2.2). Returns false
  // if no request will come.
  bool wait_for_request();
  // Reads the request line and headers up to the empty line. Throws HttpError.
  Head read_head();

  // Reads the body of the request with this head. Passes the number of bytes so far to `received` as they
  // arrive; an exception of `received` ends the read. Throws HttpError.
  using Received = std::function<void(std::size_t)>;
  std::string read_body(const Head& head, const BodyLimit& limit, const Received& received);
  // Whether bytes of this request may still arrive. The connection cannot be reused then.
  bool body_unread() const { return body_left_ > 0; }

  // Writes the pieces in order and blocks until the kernel has taken all bytes. Returns false if the client
  // has disconnected or reads too slowly. REQUIRES: at most kMaxPieces pieces.
  static constexpr std::size_t kMaxPieces = 6;
  bool write(std::initializer_list<std::string_view> pieces);

  // Discards input for up to 2 s before the connection closes. An immediate close would reset a client that
  // still sends, and it would lose the response.
  void linger();

  int fd() const { return fd_; }
  bool is_disconnected() const { return broken_ || ended_; }  // disconnected before the response ended
  void shut_down() const;                                     // shuts the socket down
  // Makes the destructor reset the connection. A normal close would mark the end of an HTTP/1.0 body.
  void reset_on_close() { resets_on_close_ = true; }

  // Begins a request of `client`. Returns the stop source that a disconnect or evict() triggers.
  std::stop_source begin_request(const std::string& client);
  // Client of the latest request. Before the first request, the network of the peer.
  std::string client() const;

  // State of the connection's thread. Each byte transferred moves the start of the wait forward, so that a
  // client at the minimum rate or above is never late.
  WaitState& waiting() { return waiting_; }
  // Evicts the connection if it still waits for `kind`; its thread becomes free soon. Returns false
  // otherwise.
  bool evict(WaitState::Kind kind);
  bool is_evicted() const { return waiting_.was_evicted(); }

  std::uint64_t bytes_written() const { return written_; }
  const IpAddress& peer() const { return peer_; }
  const std::string& network() const { return network_; }  // the peer's

 private:
  using Clock = WaitState::Clock;
  class MinimumRate;
  enum class Ready { socket, wake, none };

  // Waits until the socket is ready for `events` or broken, with `heed_wake` also until shutdown begins.
  // Returns Ready::none at the deadline or after eviction.
  Ready wait(short events, Clock::time_point deadline, bool heed_wake);
  // Appends input to `received_`, and waits for it if necessary. Returns false if the client has
  // disconnected, at the deadline or after eviction.
  bool receive(Clock::time_point deadline);
  bool wait_to_receive(Clock::time_point deadline);
  std::string read_counted(std::size_t length, const Received& received);
  std::string read_chunks(const BodyLimit& limit, const Received& received);
  void receive_part(MinimumRate& pace);
  // Skips empty lines. Returns true if other input follows them.
  bool skip_empty_lines();
  // Returns the error for a `part` of a request that did not arrive in time.
  HttpError too_late(const std::string& part) const;
  // Credits `bytes` against the minimum rate: moves `since` forward by their time, at most to now.
  void count_progress(Clock::time_point& since, std::size_t bytes) const;

  const int fd_, wake_;
  const IpAddress peer_;
  const std::string network_;
  const Timeouts patience_;
  std::string received_;  // input that is not consumed yet
  std::size_t body_left_ = 0;
  int empty_lines_ = 0;  // skipped before the current request
  bool fresh_ = true;    // no wait for a request yet
  std::uint64_t written_ = 0;
  Clock::time_point reading_since_;                     // start of the wait for input, see waiting()
  std::optional<Clock::time_point> writing_since_;      // first blocked write of the response
  std::optional<Clock::time_point> shutdown_deadline_;  // deadline for input after shutdown began
  WaitState waiting_;
  mutable std::mutex mutex_;
  std::string client_;        // guarded by mutex_
  std::stop_source request_;  // guarded by mutex_
  bool ended_ = false;        // input ended where more was expected
  bool resets_on_close_ = false;
  mutable std::atomic<bool> broken_{false};
};

}  // namespace orrery
