#include "server/http/server.h"

#include <httplib.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <list>
#include <mutex>
#include <thread>

#include "server/http/budget.h"
#include "server/http/connection.h"
#include "server/http/listener.h"
#include "server/http/request_id.h"
#include "server/http/shed.h"
#include "server/http/target.h"
#include "server/http/threads.h"

namespace orrery {
namespace {

using Clock = std::chrono::steady_clock;

// One request and its answer.
struct Exchange {
  Connection& connection;
  Head head;
  Request request;
  Response response;
  std::exception_ptr refusal;  // why there is no request
  Budget::Share body;          // as long as it is used
  bool keep_alive = false;
};

// How the handlers inside httplib get at the exchange: it rides on a callback that only httplib's client
// uses.
struct Rider {
  Exchange* exchange;
  bool operator()(std::uint64_t, std::uint64_t) const { return true; }
};

class SinkOfHttplib final : public Sink {
 public:
  explicit SinkOfHttplib(httplib::DataSink& sink) : sink_(sink) {}
  bool write(std::string_view bytes) override { return sink_.write(bytes.data(), bytes.size()); }

 private:
  httplib::DataSink& sink_;
};

// Hands the answer to httplib, which writes it.
void fill(Exchange& exchange, httplib::Response& out) {
  Response& response = exchange.response;
  out.status = response.status;
  for (const auto& [name, value] : response.headers)
    if (!equal_ignoring_case(name, "Content-Type")) out.set_header(name, value);
  const std::string type = find_field(response.headers, "Content-Type").value_or("");
  if (response.stream && exchange.request.method != "HEAD") {
    const auto provider = [&response](std::size_t, httplib::DataSink& sink) {
      SinkOfHttplib adapter(sink);
      try {
        response.stream(adapter);
      } catch (const std::exception& error) {
        response.note = error.what();
        return false;
      }
      sink.done();
      return true;
    };
    if (exchange.head.minor_version == 1) return out.set_chunked_content_provider(type, provider);
    exchange.keep_alive =
        false;  // HTTP/1.0 knows no chunks: the end of the connection is the end of the body
    return out.set_content_provider(type, provider);
  }
  if (!type.empty()) out.set_header("Content-Type", type);
  out.body = std::move(response.body);
}

// Headers that follow from how the connection goes on, and none that would be wrong.
void finish_headers(Exchange& exchange, httplib::Response& out) {
  if (exchange.connection.body_unread()) exchange.keep_alive = false;
  for (const char* name : {"Keep-Alive", "Connection", "Accept-Ranges"}) out.headers.erase(name);
  if (!exchange.keep_alive)
    out.set_header("Connection", "close");
  else if (exchange.head.minor_version == 0)
    out.set_header("Connection", "keep-alive");
  const bool length_unknown = exchange.request.method == "HEAD" && out.body.empty();
  if (length_unknown || out.status == 204 || out.status == 304) out.headers.erase("Content-Length");
}

// httplib as a writer of answers: it gets a request line of ours (see Connection), asks for the answer before
// it would route, and writes it.
class Engine final : public httplib::Server {
 public:
  explicit Engine(const HttpServer::Handler& handler) {
    svr_sock_ = 0;  // httplib ends streams while this is no socket; it never uses it here
    set_pre_routing_handler([&handler](const httplib::Request& in, httplib::Response& out) {
      Exchange& exchange = exchange_of(in);
      exchange.response = exchange.refusal ? handler.refuse(exchange.request, exchange.refusal)
                                           : handler.answer(exchange.request);
      fill(exchange, out);
      return HandlerResponse::Handled;
    });
    set_post_routing_handler(
        [](const httplib::Request& in, httplib::Response& out) { finish_headers(exchange_of(in), out); });
    set_exception_handler([](const httplib::Request&, httplib::Response& out, std::exception_ptr) {
      out.status = 500;  // out of memory, most likely: without a body
    });
  }
  ~Engine() override { svr_sock_ = INVALID_SOCKET; }

  bool answer(Exchange& exchange) {
    const bool head_only = exchange.request.method == "HEAD";
    exchange.connection.offer(head_only ? "HEAD / HTTP/1.1\r\n\r\n" : "GET / HTTP/1.1\r\n\r\n");
    bool closed = false;
    return process_request(exchange.connection, false, closed,
                           [&](httplib::Request& in) { in.progress = Rider{&exchange}; });
  }

 private:
  static Exchange& exchange_of(const httplib::Request& in) { return *in.progress.target<Rider>()->exchange; }
};

}  // namespace

class HttpServer::Parts {
 public:
  Parts(const Options& options, Handler handler)
      : options_(options),
        handler_(std::move(handler)),
        listener_(options.host, options.port),
        wake_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
        bodies_(options.max_bodies, "bodies_bytes"),
        engine_(handler_),
        threads_(options.max_connections) {}
  ~Parts() { close(wake_); }

  int port() const { return listener_.port(); }
  std::uint64_t refused() const { return refused_; }
  std::size_t connections() const {
    const std::lock_guard lock(mutex_);
    return open_.size();
  }

  void run() {
    while (!draining_) {
      pollfd ready[] = {{listener_.fd(), POLLIN, 0}, {wake_, POLLIN, 0}};
      poll(ready, 2, 1000);
      accept_all();
    }
    const auto deadline = Clock::now() + options_.grace;
    while (busy_ > 0 && Clock::now() < deadline) {
      pollfd ready{listener_.fd(), POLLIN, 0};
      poll(&ready, 1, 10);
      accept_all();
    }
    if (busy_ > 0) end_now();
  }

  void drain() {
    draining_ = true;
    eventfd_write(wake_, 1);  // nobody reads it: it wakes all who wait, now and later
  }

 private:
  void accept_all() {
    shed_.close_old();
    for (int fd; (fd = listener_.accept()) >= 0;) {
      if (threads_.start([this, fd] { serve(fd); })) continue;
      ++refused_;
      shed_.refuse(fd, refusal());
    }
  }

  // What those get who cannot be heard.
  std::string refusal() const {
    Request request;
    request.start = Clock::now();
    request.id = make_request_id();
    const Busy busy(std::to_string(options_.max_connections) + " connections are open already (connections)",
                    1);
    const Response response = handler_.refuse(request, std::make_exception_ptr(busy));
    std::string bytes = "HTTP/1.1 " + std::to_string(response.status) + " " +
                        std::string(reason_phrase(response.status)) + "\r\n";
    for (const auto& [name, value] : response.headers) bytes += name + ": " + value + "\r\n";
    return bytes + "Connection: close\r\nContent-Length: " + std::to_string(response.body.size()) +
           "\r\n\r\n" + response.body;
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
    Connection connection(fd, wake_, Patience{});
    const auto entry = remember(connection);
    while (connection.wait_for_request()) {
      ++busy_;
      bool go_on = false;
      try {
        go_on = exchange(connection);
      } catch (const std::exception&) {  // out of memory before there was a request to answer
      }
      --busy_;
      if (!go_on) break;
    }
    const std::lock_guard lock(mutex_);
    open_.erase(entry);
  }

  std::list<const Connection*>::iterator remember(const Connection& connection) {
    const std::lock_guard lock(mutex_);
    return open_.insert(open_.end(), &connection);
  }

  // Answers one request. False if the connection ends with it.
  bool exchange(Connection& connection) {
    Exchange exchange{
        .connection = connection, .head = {}, .request = {}, .response = {}, .refusal = {}, .body = {}};
    exchange.request.start = Clock::now();
    exchange.request.id = make_request_id();
    try {
      exchange.head = connection.read_head();
      take(exchange);
    } catch (const HttpError&) {
      exchange.refusal = std::current_exception();
      exchange.keep_alive = false;
      if (connection.gone()) return false;  // it only came and went
    }
    const std::uint64_t before = connection.bytes_written();
    const bool written = engine_.answer(exchange);
    const bool gone = connection.gone() || (!written && exchange.response.note.empty());
    handler_.served(exchange.request, exchange.response, connection.bytes_written() - before, gone);
    return written && exchange.keep_alive && !draining_;
  }

  void take(Exchange& exchange) {
    Request& request = exchange.request;
    const Head& head = exchange.head;
    request.method = head.method;
    request.path = head.target.substr(0, head.target.find('?'));  // for the log, should the rest fail
    request.headers = head.headers;
    request.client = exchange.connection.network();
    if (const auto id = head.header("X-Request-ID"); id && is_request_id(*id)) request.id = *id;
    Target target = parse_target(head.target);
    request.path = std::move(target.path);
    request.segments = std::move(target.segments);
    request.query = std::move(target.query);
    request.gone = [&connection = exchange.connection] { return connection.gone(); };
    request.body_limit = {options_.max_body, "body_bytes"};
    request.read_body = [this, &exchange] {
      const std::size_t length = exchange.head.content_length.value_or(0);
      if (length <= exchange.request.body_limit.bytes) exchange.body = bodies_.take(length);
      return exchange.connection.read_body(exchange.head, exchange.request.body_limit);
    };
    exchange.keep_alive = head.keep_alive && !draining_;
  }

  const Options options_;
  const Handler handler_;
  const Listener listener_;
  const int wake_;
  Budget bodies_;
  Engine engine_;
  Shed shed_;
  std::atomic<bool> draining_{false};
  std::atomic<int> busy_{0};  // requests being read or answered
  std::atomic<std::uint64_t> refused_{0};
  mutable std::mutex mutex_;
  std::list<const Connection*> open_;  // guarded by mutex_
  ConnectionThreads threads_;          // last: its threads use the others
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
