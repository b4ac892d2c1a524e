#include "server/http/exchange.h"

#include <optional>

#include "server/http/over_limit.h"
#include "server/http/request_id.h"
#include "server/http/target.h"

namespace orrery {
namespace {

constexpr int kClientGone = 499;  // the status of work that was given up

// The host of an absolute target is meant, whatever Host says (RFC 9112, 3.2.2).
void name_host(Fields& headers, const std::string& authority) {
  std::erase_if(headers, [](const auto& field) { return equal_ignoring_case(field.first, "Host"); });
  headers.emplace_back("Host", authority);
}

// Takes over what the head says. Throws HttpError for a target that cannot be understood.
void read_head_into(Request& request, const Head& head, const IpAddress& peer, const Forwarding& forwarding) {
  request.method = head.method;
  request.path = head.target.substr(0, head.target.find('?'));  // for the log, should the rest fail
  request.headers = head.headers;
  request.client = peer.network();
  if (const auto id = head.header("X-Request-ID"); id && is_request_id(*id)) request.id = *id;
  if (head.target == "*" && head.method == "OPTIONS") return;  // the server as a whole (RFC 9112, 3.2.4)
  Target target = parse_target(head.target);
  request.path = std::move(target.path);
  request.segments = std::move(target.segments);
  request.query = std::move(target.query);
  if (!target.authority.empty()) name_host(request.headers, target.authority);
  forwarding.apply(peer, request);
}

}  // namespace

bool Exchanger::exchange(Connection& connection) {
  Request request;
  request.start = std::chrono::steady_clock::now();
  request.id = make_request_id();
  Head head;
  Framing framing{.keep_alive = false};
  try {
    head = connection.read_head();
    framing = {.head_only = head.method == "HEAD", .minor_version = head.minor_version, .keep_alive = false};
    read_head_into(request, head, connection.peer(), forwarding_);
  } catch (const HttpError&) {
    if (connection.left()) return false;  // it only came and went
    return send(connection, request, handler_.refuse(request, std::current_exception()), framing);
  }
  framing.keep_alive = head.keep_alive;
  const std::string client = request.client;  // by its address: tokens name it otherwise
  Budget::Share body(bodies_, client);        // as long as it is used
  HttpServer::Admitted admitted;
  try {
    admitted = handler_.admit(request);
    if (admitted.body)  // takes of the budget what has come: what is only announced takes nothing from others
      request.body =
          Body(connection.read_body(head, *admitted.body, [&](std::size_t bytes) { body.grow(bytes); }));
  } catch (...) {
    return send(connection, request, handler_.refuse(request, std::current_exception()), framing);
  }
  const std::stop_source gone = connection.begin_request(client);
  request.gone = gone.get_token();
  // HTTP/1.0 knows no interim responses.
  HangupMonitor::Watching watching = monitor_.watch(connection.fd(), gone, framing.minor_version == 1);
  std::optional<HandlerSlots::Handler> handler;
  Response response;
  try {
    handler.emplace(slots_, client, request.gone, connection.waiting());
    response = admitted.answer(request);
  } catch (...) {
    response = refuse(connection, request, std::current_exception());
  }
  watching.stop_asking();
  return send(connection, request, std::move(response), framing);
}

Response Exchanger::refuse(const Connection& connection, const Request& request,
                           std::exception_ptr error) const {
  if (connection.made_room())
    error = std::make_exception_ptr(ClientBusy(
        "Others want a connection, and your address has most of them (connections)", 1, "connections"));
  return handler_.refuse(request, error);
}

bool Exchanger::send(Connection& connection, const Request& request, Response response, Framing framing) {
  const bool ends_with_it = response.stream && framing.minor_version == 0;  // which knows no chunks
  if (ends_with_it || draining_ || connection.body_unread() || connection.made_room())
    framing.keep_alive = false;
  const Sender sender{answers_, request.client, request.gone};
  AnswerBudget::Share share;
  try {
    if (has_body(response, framing)) share = answers_.take(response.body, request.client);
  } catch (const Busy&) {
    response = handler_.refuse(request, std::current_exception());
  }
  const std::uint64_t before = connection.bytes_written();
  const bool written = write_response(connection, response, framing, sender);
  if (response.stream) {
    const HandlerSlots::Wait released;  // the end of a stream may wait for its threads
    response.stream = nullptr;
  }
  // Who leaves after the last byte has got its answer.
  const bool gone =
      connection.left() || response.status == kClientGone || (!written && response.note.empty());
  handler_.served(request, response, connection.bytes_written() - before, gone);
  return written && framing.keep_alive;
}

}  // namespace orrery
