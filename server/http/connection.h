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
#include "server/http/waiting.h"

namespace orrery {

// How long a client may take. The limits hold from the first byte of a request.
struct Patience {
  std::chrono::milliseconds idle{15'000};  // between two requests
  std::chrono::milliseconds head{5'000};   // for request line and headers
  // Of bodies and answers, in each window: this rate or better, so that all of it crosses in `whole`.
  std::size_t bytes_per_s = 1024;
  std::chrono::seconds whole{600};
  std::chrono::seconds window{10};
  std::chrono::milliseconds last_call{1'000};  // for the rest of a request once the service ends
};

// One client's socket: requests are read from it, answers are written to it. For the thread that serves the
// connection, except abandon(), client(), waiting() and make_room().
class Connection final {
 public:
  // Takes the socket, which must not block. `wake` becomes readable when the service ends: idle connections
  // end then, and half a request has a last call.
  Connection(int fd, const IpAddress& peer, int wake, const Patience& patience);
  ~Connection();
  Connection(const Connection&) = delete;

  // Waits for the first byte of a request. Empty lines before it are skipped, a few (RFC 9112, 2.2). False:
  // there will be none.
  bool wait_for_request();
  // Reads up to the empty line. Throws HttpError.
  Head read_head();

  // Reads the body of the request with this head. Throws HttpError.
  // `received` is told how many bytes there are, each time that some have come; what it throws ends the
  // reading.
  using Received = std::function<void(std::size_t)>;
  std::string read_body(const Head& head, const BodyLimit& limit, const Received& received);
  // Whether bytes of this request may still be under way; then nothing after it can be understood.
  bool body_unread() const { return body_left_ > 0; }

  // Sends these bytes, one piece after the other, and waits until the kernel has taken them all. False: the
  // client has left, or takes nothing any more. REQUIRES: at most kMostPieces.
  static constexpr std::size_t kMostPieces = 6;
  bool write(std::initializer_list<std::string_view> pieces);

  // Before the end of a connection: waits a little for what the client still sends, which would otherwise see
  // a broken connection instead of the answer.
  void linger();

  int fd() const { return fd_; }
  bool left() const { return broken_ || ended_; }  // seen before the answer ended
  void abandon() const;                            // breaks it off
  // Has the client see a reset instead of an end, which it would take for that of the answer.
  void end_by_reset() { ends_by_reset_ = true; }

  // A request of that client begins. Returns what ends it early: its client has gone, or make_room().
  std::stop_source begin_request(const std::string& client);
  // Of the latest request; before the first, the peer's network.
  std::string client() const;

  // What its thread waits for. A body that comes, or an answer that is taken, at the least rate allowed keeps
  // nobody waiting: the wait for the client begins later then.
  Waiting& waiting() { return waiting_; }
  // Ends a connection that still waits for that, and gives its thread back soon. Returns false otherwise.
  bool make_room(Waiting::Kind kind);
  bool made_room() const { return waiting_.gave_up(); }

  std::uint64_t bytes_written() const { return written_; }
  const IpAddress& peer() const { return peer_; }
  const std::string& network() const { return network_; }  // of the peer

 private:
  using Clock = Waiting::Clock;
  class Pace;
  enum class Ready { socket, wake, none };

  // Until the socket is ready for `events` or broken, with `heed_wake` also until the service ends. None:
  // time is up, or room had to be made.
  Ready wait(short events, Clock::time_point deadline, bool heed_wake);
  // Appends what has come to `received_`, after waiting for it. False: the client has closed, or time is up.
  bool receive(Clock::time_point deadline);
  bool wait_to_receive(Clock::time_point deadline);
  std::string read_counted(std::size_t length, const Received& received);
  std::string read_chunks(const BodyLimit& limit, const Received& received);
  void receive_part(Pace& pace);
  // Whether something begins that is no empty line.
  bool skip_empty_lines();
  // Why `part` of a request did not come.
  HttpError too_late(const std::string& part) const;
  // So many bytes more have crossed: the client is late by so much less.
  void count_progress(Clock::time_point& since, std::size_t bytes) const;

  const int fd_, wake_;
  const IpAddress peer_;
  const std::string network_;
  const Patience patience_;
  std::string received_;  // read from the socket, not used yet
  std::size_t body_left_ = 0;
  int empty_lines_ = 0;  // before the request
  bool fresh_ = true;    // no request was waited for yet
  std::uint64_t written_ = 0;
  Clock::time_point reading_since_;                 // see waiting()
  std::optional<Clock::time_point> writing_since_;  // the same for the answer, once it had to wait
  std::optional<Clock::time_point> last_call_;      // when it ends
  Waiting waiting_;
  mutable std::mutex mutex_;
  std::string client_;        // guarded by mutex_
  std::stop_source request_;  // likewise
  bool ended_ = false;        // the client sends no more, though it owes something
  bool ends_by_reset_ = false;
  mutable std::atomic<bool> broken_{false};
};

}  // namespace orrery
