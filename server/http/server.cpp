#include "server/http/server.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <list>
#include <mutex>
#include <optional>
#include <thread>

#include "server/http/connection.h"
#include "server/http/exchange.h"
#include "server/http/listener.h"
#include "server/http/request_id.h"
#include "server/http/response_writer.h"
#include "server/http/shed.h"
#include "server/http/threads.h"

namespace orrery {
namespace {

// Wakes all who wait for it, now and later.
class Alarm {
 public:
  Alarm() : fd_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}
  ~Alarm() { close(fd_); }
  Alarm(const Alarm&) = delete;
  int fd() const { return fd_; }
  void ring() const { eventfd_write(fd_, 1); }  // nobody reads it

 private:
  const int fd_;
};

}  // namespace

class HttpServer::Parts {
 public:
  Parts(const Options& options, Handler handler)
      : options_(options),
        handler_(std::move(handler)),
        listener_(std::in_place, options.host, options.port),
        port_(listener_->port()),
        exchanger_(options, handler_),
        threads_(options.max_connections) {}

  int port() const { return port_; }
  std::uint64_t refused() const { return refused_; }
  std::size_t connections() const {
    const std::lock_guard lock(mutex_);
    return open_.size();
  }

  void run() {
    while (!draining_) {
      pollfd ready[] = {{listener_->fd(), POLLIN, 0}, {wake_.fd(), POLLIN, 0}};
      poll(ready, 2, 1000);
      accept_all();
    }
    const auto deadline = Clock::now() + options_.grace;
    while (busy_ > 0 && Clock::now() < deadline) {
      pollfd ready{listener_->fd(), POLLIN, 0};
      poll(&ready, 1, 10);
      accept_all();
    }
    if (busy_ > 0) end_now();
    accept_all();
    listener_.reset();  // who comes now is refused at once instead of being left without an answer
  }

  void drain() {
    draining_ = true;
    exchanger_.drain();
    wake_.ring();
  }

 private:
  void accept_all() {
    shed_.close_old();
    for (int fd; (fd = listener_->accept()) >= 0;) {
      const auto work = [this, fd] { serve(fd); };
      if (threads_.start(work)) continue;
      if (make_room()) {
        threads_.start_next(work);
      } else {
        ++refused_;
        shed_.refuse(fd, refusal());
      }
    }
  }

  // Ends the connection whose client has kept its thread waiting longest, if any has for a while. Slow
  // clients, however many, then take no place from those who know what they want.
  bool make_room() {
    constexpr std::chrono::milliseconds kWhile{100};  // what is sent at once has come by then
    const std::lock_guard lock(mutex_);
    std::vector<std::pair<Clock::time_point, Connection*>> candidates;
    for (Connection* connection : open_)
      if (const auto since = connection->waiting(); since && Clock::now() - *since >= kWhile)
        candidates.emplace_back(*since, connection);
    std::sort(candidates.begin(), candidates.end());
    return std::any_of(candidates.begin(), candidates.end(),
                       [](const auto& candidate) { return candidate.second->make_room(); });
  }

  // What those get who cannot be heard.
  std::string refusal() const {
    Request request;
    request.start = Clock::now();
    request.id = make_request_id();
    const Busy busy(std::to_string(options_.max_connections) + " connections are open already (connections)",
                    1);
    const Response response = handler_.refuse(request, std::make_exception_ptr(busy));
    return response_head(response, {.keep_alive = false}) + response.body;
  }

  // The handler is told that time is up; connections that do not end even then are broken off.
  void end_now() {
    handler_.grace_over();
    const auto deadline = Clock::now() + std::chrono::seconds(2);
    while (busy_ > 0 && Clock::now() < deadline) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const std::lock_guard lock(mutex_);
    for (const Connection* connection : open_) connection->abandon();
  }

  void serve(int fd) {
    Connection connection(fd, wake_.fd(), Patience{});
    const auto entry = remember(connection);
    while (connection.wait_for_request()) {
      ++busy_;
      bool go_on = false;
      try {
        go_on = exchanger_.exchange(connection);
      } catch (const std::exception&) {  // out of memory before there was a request to answer
      }
      --busy_;
      if (!go_on) break;
    }
    connection.linger();
    const std::lock_guard lock(mutex_);
    open_.erase(entry);
  }

  std::list<Connection*>::iterator remember(Connection& connection) {
    const std::lock_guard lock(mutex_);
    return open_.insert(open_.end(), &connection);
  }

  const Options options_;
  const Handler handler_;
  std::optional<Listener> listener_;
  const int port_;
  const Alarm wake_;
  Exchanger exchanger_;
  Shed shed_;
  std::atomic<bool> draining_{false};
  std::atomic<int> busy_{0};  // requests being read or answered
  std::atomic<std::uint64_t> refused_{0};
  mutable std::mutex mutex_;
  std::list<Connection*> open_;  // guarded by mutex_
  ConnectionThreads threads_;    // last: its threads use the others
};

HttpServer::HttpServer(const Options& options, Handler handler)
    : parts_(std::make_unique<Parts>(options, std::move(handler))) {}
HttpServer::~HttpServer() = default;
int HttpServer::port() const { return parts_->port(); }
std::size_t HttpServer::connections() const { return parts_->connections(); }
std::uint64_t HttpServer::refused() const { return parts_->refused(); }
void HttpServer::run() { parts_->run(); }
void HttpServer::drain() { parts_->drain(); }

}  // namespace orrery
