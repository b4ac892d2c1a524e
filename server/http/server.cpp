#include "server/http/server.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <limits>
#include <list>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <tuple>

#include "server/base/request_id.h"
#include "server/http/connection.h"
#include "server/http/listener.h"
#include "server/http/overload_responder.h"
#include "server/http/raw_response.h"
#include "server/http/session.h"
#include "server/http/threads.h"

namespace orrery {
namespace {

// Event that wakes all waiting threads until it is silenced.
class Alarm {
 public:
  Alarm() : fd_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}
  ~Alarm() { close(fd_); }
  Alarm(const Alarm&) = delete;
  int fd() const { return fd_; }
  void ring() const { eventfd_write(fd_, 1); }
  void silence() const {
    eventfd_t rings;
    eventfd_read(fd_, &rings);
  }

 private:
  const int fd_;
};

constexpr int kNothing = -1;                     // no descriptor to wait for
constexpr std::chrono::milliseconds kRetry{50};  // interval of accept() attempts while no descriptor is left

// Waits until `a` or `b` is readable or the deadline has passed.
void wait_for_either(int a, int b, Clock::time_point deadline) {
  pollfd ready[] = {{a, POLLIN, 0}, {b, POLLIN, 0}};
  int limit_ms = -1;
  if (deadline != Clock::time_point::max()) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
    limit_ms = static_cast<int>(std::clamp<std::int64_t>(left, 0, std::numeric_limits<int>::max()));
  }
  poll(ready, 2, limit_ms);
}

}  // namespace

class HttpServer::Parts {
 public:
  Parts(const Options& options, Handler handler)
      : options_(options),
        handler_(std::move(handler)),
        listener_(std::in_place, options.host, options.port),
        port_(listener_->port()),
        sessions_(options, handler_, monitor_),
        threads_(options.max_connections) {}

  int port() const { return port_; }
  std::uint64_t refused() const { return refused_; }
  std::size_t connections() const {
    const std::lock_guard lock(mutex_);
    return open_.size();
  }

  bool exhausted() const {
    const std::lock_guard lock(mutex_);
    return open_.size() >= options_.max_connections && candidates(1).empty();
  }

  void run() {
    while (!draining_) {
      wait_for_connection_or(wake_, Clock::time_point::max());
      accept_all();
    }
    if (!answer_all(Clock::now() + options_.grace)) end_now();
    accept_all();
    listener_.reset();  // rejects new connections at once instead of leaving them unanswered
  }

  void drain() {
    draining_ = true;
    sessions_.draining = true;
    wake_.ring();
  }

 private:
  void wait_for_connection_or(const Alarm& alarm, Clock::time_point deadline) {
    if (listener_->out_of_room())  // the pending connection keeps the listener readable
      wait_for_either(kNothing, alarm.fd(), std::min(deadline, Clock::now() + kRetry));
    else
      wait_for_either(listener_->fd(), alarm.fd(), std::min(deadline, shed_.next_close()));
  }

  void accept_all() {
    shed_.close_old();
    for (int fd; (fd = listener_->accept()) >= 0;) {
      const IpAddress peer = IpAddress::of_peer(fd);
      const std::string network = peer.network();
      const bool trusted = options_.forwarding.trusts(peer);
      const bool over_share =
          count(network) > share_of_one() && share_of_one() < options_.max_connections && !trusted;
      if ((!over_share && threads_.has_room()) || evict(network, over_share, !trusted)) {
        const auto connection = std::make_shared<Connection>(fd, peer, wake_.fd(), Timeouts{});
        threads_.start([this, connection, entry = remember(*connection)] { serve(*connection, entry); });
      } else {
        forget(network);
        ++refused_;
        shed_.refuse(fd, refusal(over_share));
      }
    }
  }

  // Returns the maximum number of connections of one network. One quarter is reserved for other networks.
  std::size_t share_of_one() const { return options_.max_connections - options_.max_connections / 4; }
  // Counts a new connection of the network. Returns the network's number of connections.
  std::size_t count(const std::string& network) {
    const std::lock_guard lock(mutex_);
    return ++of_network_[network];
  }
  void forget(const std::string& network) {
    const std::lock_guard lock(mutex_);
    const auto known = of_network_.find(network);
    if (--known->second == 0) of_network_.erase(known);
  }

  struct Candidate {
    // Eviction order: clients with the most connections first, then by kind of wait. Waits for the client of
    // 100 ms or more precede shorter ones, the longest first. All other waits are ordered newest first.
    std::tuple<std::ptrdiff_t, WaitState::Kind, bool, Clock::duration> rank;
    Connection* connection;
  };
  // Returns the connections that may be evicted for a newcomer, in eviction order. `of_newcomer`: number of
  // connections of the newcomer's client, including the new one. Requires mutex_.
  std::vector<Candidate> candidates(std::size_t of_newcomer) const {
    constexpr std::chrono::milliseconds kWhile{100};  // a request that is sent at once arrives by then
    std::map<std::string, std::size_t> counts;        // by client, which may be behind a proxy
    for (const Connection* connection : open_) ++counts[connection->client()];
    std::vector<Candidate> found;
    for (Connection* connection : open_) {
      const auto kind = connection->waiting().kind();
      if (!kind) continue;
      const auto since = connection->waiting().since();
      const bool fresh = *kind != WaitState::Kind::client || Clock::now() - since < kWhile;
      const std::size_t others = counts[connection->client()];
      if (fresh && others <= of_newcomer) continue;
      const auto age = since.time_since_epoch();
      found.push_back({{-static_cast<std::ptrdiff_t>(others), *kind, fresh, fresh ? -age : age}, connection});
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.rank < b.rank; });
    return found;
  }

  // Evicts a connection for a newcomer from `network`. Returns false if none can be evicted. `own`: evicts
  // only connections of the same network that wait for their client. `known`: the network identifies the
  // newcomer's client, because it is not a trusted proxy.
  bool evict(const std::string& network, bool own, bool known) {
    const std::lock_guard lock(mutex_);
    const std::vector<Candidate> found = candidates(known ? of_network_[network] : 1);
    return std::any_of(found.begin(), found.end(), [&](const Candidate& candidate) {
      const WaitState::Kind kind = std::get<WaitState::Kind>(candidate.rank);
      if (own && (kind != WaitState::Kind::client || candidate.connection->network() != network))
        return false;
      return candidate.connection->evict(kind);
    });
  }

  // Returns the response for rejected connections. Their requests are not read.
  std::string refusal(bool over_share) const {
    Request request;
    request.start = Clock::now();
    request.id = make_request_id();
    const auto open = [](std::size_t count, const char* whose, const char* limit) {
      const std::string number = std::to_string(count);
      return number + " connections" + whose + " are open (limit " + number + limit + ", connections)";
    };
    const auto error =
        over_share ? std::make_exception_ptr(ClientLimitExceeded(
                         open(share_of_one(), " from this address", " per address"), 1, "connections"))
                   : std::make_exception_ptr(
                         LimitExceeded(open(options_.max_connections, "", ""), 1, "connections"));
    const Response response = handler_.refuse(request, error);
    return raw_response(response);
  }

  // Waits until no request is being answered. Returns false at the deadline.
  bool answer_all(Clock::time_point deadline) {
    while (busy_ > 0 && Clock::now() < deadline) {
      wait_for_connection_or(idle_, deadline);
      idle_.silence();
      accept_all();
    }
    return busy_ == 0;
  }

  // Calls Handler::grace_over(). Shuts down the connections that are still open 2 s later.
  void end_now() {
    handler_.grace_over();
    if (answer_all(Clock::now() + std::chrono::seconds(2))) return;
    const std::lock_guard lock(mutex_);
    for (const Connection* connection : open_) connection->shut_down();
  }

  using Open = std::list<Connection*>;

  // Reads and answers one request. Returns false if the connection must close.
  bool answer(Session& session) {
    struct BusyGuard {
      Parts& parts;
      explicit BusyGuard(Parts& all) : parts(all) { ++parts.busy_; }
      ~BusyGuard() {
        if (--parts.busy_ == 0 && parts.draining_) parts.idle_.ring();
      }
    };
    const BusyGuard counted(*this);
    return session.exchange();
  }

  void serve(Connection& connection, Open::iterator entry) {
    try {
      Session session(sessions_, connection);
      while (connection.wait_for_request() && answer(session)) {
      }
      connection.linger();
    } catch (const std::exception&) {  // out of memory without a request to answer
    }
    {
      const std::lock_guard lock(mutex_);
      open_.erase(entry);
    }
    forget(connection.network());
  }

  Open::iterator remember(Connection& connection) {
    const std::lock_guard lock(mutex_);
    return open_.insert(open_.end(), &connection);
  }

  const Options options_;
  const Handler handler_;
  std::optional<Listener> listener_;
  const int port_;
  const Alarm wake_, idle_;  // shutdown begins; no request is left during shutdown
  HangupMonitor monitor_;
  SessionServices sessions_;
  OverloadResponder shed_;
  std::atomic<bool> draining_{false};
  std::atomic<int> busy_{0};  // requests being read or answered
  std::atomic<std::uint64_t> refused_{0};
  mutable std::mutex mutex_;
  Open open_;                                      // newest last; guarded by mutex_
  std::map<std::string, std::size_t> of_network_;  // accepted connections; guarded by mutex_
  ConnectionThreads threads_;                      // last: its threads use the other members
};

HttpServer::HttpServer(const Options& options, Handler handler)
    : parts_(std::make_unique<Parts>(options, std::move(handler))) {}
HttpServer::~HttpServer() = default;
int HttpServer::port() const { return parts_->port(); }
std::size_t HttpServer::connections() const { return parts_->connections(); }
std::uint64_t HttpServer::refused() const { return parts_->refused(); }
bool HttpServer::exhausted() const { return parts_->exhausted(); }
void HttpServer::run() { parts_->run(); }
void HttpServer::drain() { parts_->drain(); }

}  // namespace orrery
