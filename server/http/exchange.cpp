#include "server/http/exchange.h"

#include "server/http/request_id.h"
#include "server/http/response_writer.h"
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
  bool keep_alive = false;
};

namespace {

// The host of an absolute target is meant, whatever Host says (RFC 9112, 3.2.2).
void name_host(Fields& headers, const std::string& authority) {
  std::erase_if(headers, [](const auto& field) { return equal_ignoring_case(field.first, "Host"); });
  headers.emplace_back("Host", authority);
}

}  // namespace

Exchanger::Exchanger(const HttpServer::Options& options, const HttpServer::Handler& handler)
    : max_body_(options.max_body), handler_(handler), bodies_(options.max_bodies, "bodies_bytes") {}

bool Exchanger::exchange(Connection& connection) {
  Exchange exchange{
      .connection = connection, .head = {}, .request = {}, .response = {}, .refusal = {}, .body = {}};
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
  exchange.response = exchange.refusal ? handler_.refuse(exchange.request, exchange.refusal)
                                       : handler_.answer(exchange.request);
  const bool to_the_end = exchange.response.stream && exchange.head.minor_version == 0;
  if (draining_ || to_the_end || connection.body_unread()) exchange.keep_alive = false;
  const bool written = write_response(connection, exchange.response,
                                      {.head_only = exchange.request.method == "HEAD",
                                       .minor_version = exchange.head.minor_version,
                                       .keep_alive = exchange.keep_alive});
  // Who leaves after the last byte has got its answer.
  const bool gone = connection.left() || (!written && exchange.response.note.empty());
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
  request.gone = [&connection = exchange.connection] { return connection.gone(); };
  request.body_limit = {max_body_, "body_bytes"};
  request.read_body = [this, &exchange] {
    exchange.body = bodies_.share();  // of what has come: what is only announced takes nothing from others
    return exchange.connection.read_body(exchange.head, exchange.request.body_limit,
                                         [&exchange](std::size_t bytes) { exchange.body.grow(bytes); });
  };
  exchange.keep_alive = head.keep_alive && !draining_;
}

}  // namespace orrery
