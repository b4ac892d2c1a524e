#include "server/http/request_processor.h"

#include <optional>

#include "server/base/errors.h"
#include "server/base/request_id.h"
#include "server/http/target.h"

namespace orrery {
namespace {

constexpr int kClientGone = 499;  // status of requests whose client has disconnected

// Replaces Host by the host of an absolute target, which takes precedence (RFC 9112, 3.2.2).
void name_host(Fields& headers, const std::string& authority) {
  std::erase_if(headers, [](const auto& field) { return equal_ignoring_case(field.first, "Host"); });
  headers.emplace_back("Host", authority);
}

// Fills `request` from the head. Throws HttpError if the target is malformed.
void read_head_into(Request& request, const Head& head, const IpAddress& peer, const Forwarding& forwarding) {
  request.method = head.method;
  request.path = head.target.substr(0, head.target.find('?'));  // for the log, if parsing fails
  request.headers = head.headers;
  request.client = peer.network();
  if (const auto id = head.header("X-Request-ID"); id && is_request_id(*id)) request.id = *id;
  if (head.target == "*" && head.method == "OPTIONS") return;  // server-wide (RFC 9112, 3.2.4)
  Target target = parse_target(head.target);
  request.path = std::move(target.path);
  request.segments = std::move(target.segments);
  request.query = std::move(target.query);
  if (!target.authority.empty()) name_host(request.headers, target.authority);
  forwarding.apply(peer, request);
}

}  // namespace

bool RequestProcessor::exchange(Connection& connection) {
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
    if (connection.is_disconnected()) return false;  // disconnected before a complete request
    return send(connection, request, handler_.refuse(request, std::current_exception()), framing);
  }
  framing.keep_alive = head.keep_alive;
  const std::string client = request.client;  // network; admit() may set request.client to a token's name
  ByteQuota::Share body(bodies_, client);     // charged until the response is sent
  HttpServer::Admitted admitted;
  try {
    admitted = handler_.admit(request);
    if (admitted.body)  // charges bytes as they arrive, not the announced length
      request.body =
          Body(connection.read_body(head, *admitted.body, [&](std::size_t bytes) { body.grow(bytes); }));
  } catch (...) {
    return send(connection, request, handler_.refuse(request, std::current_exception()), framing);
  }
  const std::stop_source gone = connection.begin_request(client);
  request.gone = gone.get_token();
  // HTTP/1.0 has no interim responses.
  HangupMonitor::Registration watching = monitor_.watch(connection.fd(), gone, framing.minor_version == 1);
  std::optional<HandlerSlots::Handler> handler;
  Response response;
  try {
    handler.emplace(slots_, client, request.gone, connection.waiting());
    response = admitted.answer(request);
  } catch (...) {
    response = refuse(connection, request, std::current_exception());
  }
  watching.stop_probing();
  return send(connection, request, std::move(response), framing);
}

Response RequestProcessor::refuse(const Connection& connection, const Request& request,
                                  std::exception_ptr error) const {
  if (connection.is_evicted())
    error = std::make_exception_ptr(ClientLimitExceeded(
        "all connections were in use, and this client had the most (connections)", 1, "connections"));
  return handler_.refuse(request, error);
}

bool RequestProcessor::send(Connection& connection, const Request& request, Response response,
                            Framing framing) {
  const bool ends_with_it = response.stream && framing.minor_version == 0;  // HTTP/1.0 has no chunks
  if (ends_with_it || draining_ || connection.body_unread() || connection.is_evicted())
    framing.keep_alive = false;
  const Sender sender{answers_, request.client, request.gone};
  ResponseQuota::Share share;
  try {
    if (has_body(response, framing)) share = answers_.take(response.body, request.client);
  } catch (const Busy&) {
    response = handler_.refuse(request, std::current_exception());
  }
  const std::uint64_t before = connection.bytes_written();
  const bool written = write_response(connection, response, framing, sender);
  if (response.stream) {
    const HandlerSlots::Wait released;  // the stream's destructor may wait for its threads
    response.stream = nullptr;
  }
  // A client that disconnects after the last byte has received the whole response.
  const bool gone =
      connection.is_disconnected() || response.status == kClientGone || (!written && response.note.empty());
  handler_.served(request, response, connection.bytes_written() - before, gone);
  return written && framing.keep_alive;
}

}  // namespace orrery
