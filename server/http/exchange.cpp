#include "server/http/exchange.h"

#include <httplib.h>

#include "server/http/request_id.h"
#include "server/http/target.h"

namespace orrery {

// One request and its answer.
struct Exchange {
  Connection& connection;
  Head head;
  Request request;
  Response response;
  std::exception_ptr refusal;  // why there is no request
  Budget::Share body;          // as long as it is used
  std::stop_source gone;       // requested once the client has gone
  bool keep_alive = false;
};

namespace {

constexpr int kClientGone = 499;  // the status of work that was given up

// The host of an absolute target is meant, whatever Host says (RFC 9112, 3.2.2).
void name_host(Fields& headers, const std::string& authority) {
  std::erase_if(headers, [](const auto& field) { return equal_ignoring_case(field.first, "Host"); });
  headers.emplace_back("Host", authority);
}

// How the handlers inside httplib get at the exchange: it rides on a callback that only httplib's client
// uses.
struct ExchangeHandle {
  Exchange* exchange;
  bool operator()(std::uint64_t, std::uint64_t) const { return true; }
};

class SinkOfHttplib final : public Sink {
 public:
  SinkOfHttplib(httplib::DataSink& sink, const std::stop_token& gone) : sink_(sink), gone_(gone) {}
  bool write(std::string_view bytes) override {
    return !gone_.stop_requested() && sink_.write(bytes.data(), bytes.size());
  }

 private:
  httplib::DataSink& sink_;
  const std::stop_token gone_;
};

// Hands the answer to httplib, which writes it.
void fill(Exchange& exchange, httplib::Response& out) {
  Response& response = exchange.response;
  out.status = response.status;
  for (const auto& [name, value] : response.headers)
    if (!equal_ignoring_case(name, "Content-Type")) out.set_header(name, value);
  const std::string type = find_field(response.headers, "Content-Type").value_or("");
  if (response.stream && exchange.request.method != "HEAD") {
    const auto provider = [&response, gone = exchange.request.gone](std::size_t, httplib::DataSink& sink) {
      SinkOfHttplib adapter(sink, gone);
      try {
        response.stream(adapter);
      } catch (const std::exception& error) {
        response.note = error.what();
        return false;
      }
      if (gone.stop_requested()) return false;
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

}  // namespace

// httplib as a writer of answers: it gets a request line of ours (see Connection), asks for the answer before
// it would route, and writes it.
class Exchanger::Engine final : public httplib::Server {
 public:
  Engine(const HttpServer::Handler& handler, const std::atomic<bool>& draining) {
    svr_sock_ = 0;  // httplib ends streams while this is no socket; it never uses it here
    set_pre_routing_handler([&handler](const httplib::Request& in, httplib::Response& out) {
      Exchange& exchange = exchange_of(in);
      exchange.response = exchange.refusal ? handler.refuse(exchange.request, exchange.refusal)
                                           : handler.answer(exchange.request);
      fill(exchange, out);
      return HandlerResponse::Handled;
    });
    set_post_routing_handler([&draining](const httplib::Request& in, httplib::Response& out) {
      Exchange& exchange = exchange_of(in);
      if (draining) exchange.keep_alive = false;
      finish_headers(exchange, out);
    });
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
                           [&](httplib::Request& in) { in.progress = ExchangeHandle{&exchange}; });
  }

 private:
  static Exchange& exchange_of(const httplib::Request& in) {
    return *in.progress.target<ExchangeHandle>()->exchange;
  }
};

Exchanger::Exchanger(const HttpServer::Options& options, const HttpServer::Handler& handler,
                     HangupMonitor& monitor)
    : max_body_(options.max_body),
      handler_(handler),
      monitor_(monitor),
      bodies_(options.max_bodies, "bodies_bytes"),
      engine_(std::make_unique<Engine>(handler, draining_)) {}
Exchanger::~Exchanger() = default;

bool Exchanger::exchange(Connection& connection) {
  Exchange exchange{.connection = connection,
                    .head = {},
                    .request = {},
                    .response = {},
                    .refusal = {},
                    .body = {},
                    .gone = {}};
  exchange.request.start = std::chrono::steady_clock::now();
  exchange.request.id = make_request_id();
  try {
    exchange.head = connection.read_head();
    take(exchange);
  } catch (const HttpError&) {
    exchange.refusal = std::current_exception();
    exchange.keep_alive = false;
    if (connection.left()) return false;  // it only came and went
  }
  const std::uint64_t before = connection.bytes_written();
  const HangupMonitor::Watching watching = monitor_.watch(connection.socket(), exchange.gone);
  const bool written = engine_->answer(exchange);
  // Who leaves after the last byte has got its answer.
  const bool gone = connection.left() || exchange.response.status == kClientGone ||
                    (!written && exchange.response.note.empty());
  handler_.served(exchange.request, exchange.response, connection.bytes_written() - before, gone);
  return written && exchange.keep_alive;
}

// The request that the head stands for.
void Exchanger::take(Exchange& exchange) {
  Request& request = exchange.request;
  const Head& head = exchange.head;
  request.method = head.method;
  request.path = head.target.substr(0, head.target.find('?'));  // for the log, should the rest fail
  request.headers = head.headers;
  request.client = exchange.connection.network();
  if (const auto id = head.header("X-Request-ID"); id && is_request_id(*id)) request.id = *id;
  if (head.target != "*" || head.method != "OPTIONS") {  // "*" is the server as a whole (RFC 9112, 3.2.4)
    Target target = parse_target(head.target);
    request.path = std::move(target.path);
    request.segments = std::move(target.segments);
    request.query = std::move(target.query);
    if (!target.authority.empty()) name_host(request.headers, target.authority);
  }
  request.gone = exchange.gone.get_token();
  request.body_limit = {max_body_, "body_bytes"};
  request.read_body = [this, &exchange] {
    exchange.body = bodies_.share();  // of what has come: what is only announced takes nothing from others
    return exchange.connection.read_body(exchange.head, exchange.request.body_limit,
                                         [&exchange](std::size_t bytes) { exchange.body.grow(bytes); });
  };
  exchange.keep_alive = head.keep_alive && !draining_;
}

}  // namespace orrery
