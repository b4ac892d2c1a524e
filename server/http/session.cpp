#include "server/http/session.h"

#include "server/base/errors.h"
#include "server/base/request_id.h"
#include "server/http/field_list.h"
#include "server/http/raw_response.h"
#include "server/http/target.h"

namespace orrery {
namespace {

// Path of all requests for cpp-httplib. Its routes are regular expressions, whose matching recurses once per
// character and treats line breaks as special, so it never sees the path of a client. Session routes by
// itself, and passes every request with a body as a POST.
constexpr const char* kPath = "/";

constexpr int kClientGone = 499;  // status of cancelled requests

// Replaces Host by the host of an absolute target, which takes precedence (RFC 9112, 3.2.2).
void name_host(Fields& headers, const std::string& authority) {
  std::erase_if(headers, [](const auto& field) { return equal_ignoring_case(field.first, "Host"); });
  headers.emplace_back("Host", authority);
}

bool is_framing_header(std::string_view name) {
  return equal_ignoring_case(name, "Content-Length") || equal_ignoring_case(name, "Transfer-Encoding");
}

// Fills `request` from cpp-httplib's, whose header values it moves. Throws HttpError if the target is
// malformed.
void read_request_into(Request& request, httplib::Request& raw, const IpAddress& peer,
                       const Forwarding& forwarding) {
  request.method = raw.method;
  request.path = raw.target.substr(0, raw.target.find('?'));  // for the log, if parsing fails
  request.headers.reserve(raw.headers.size());
  for (auto& [name, value] : raw.headers)
    if (is_framing_header(name))
      request.headers.emplace_back(name, value);
    else
      request.headers.emplace_back(name, std::move(value));
  request.client = peer.network();
  if (const auto id = request.header("X-Request-ID"); id && is_request_id(*id)) request.id = *id;
  if (raw.target == "*" && raw.method == "OPTIONS") return;  // server-wide (RFC 9112, 3.2.4)
  Target target = parse_target(raw.target);
  request.path = std::move(target.path);
  request.segments = std::move(target.segments);
  request.query = std::move(target.query);
  if (!target.authority.empty()) name_host(request.headers, target.authority);
  forwarding.apply(peer, request);
}

// Whether the connection may stay open after the response (RFC 9112, 9.3).
bool keeps_alive(const Fields& headers, int minor_version) {
  const auto says = [&](std::string_view word) {
    bool found = false;
    for_each_entry(joined(headers, "Connection"), ',',
                   [&](std::string_view entry) { found = found || equal_ignoring_case(entry, word); });
    return found;
  };
  return minor_version == 1 ? !says("close") : says("keep-alive");
}

// Sink of a streamed response: each write is a chunk, or plain bytes for HTTP/1.0.
class BodySink final : public Sink {
 public:
  BodySink(httplib::DataSink& sink, Connection& connection, ResponseQuota& quota, const Request& request)
      : sink_(sink), connection_(connection), quota_(quota), request_(request) {}

  bool write(std::string_view bytes, const SharedBytes& more, std::string_view end) override {
    if (request_.gone.stop_requested()) return whole_ = false;
    const std::size_t count = bytes.size() + more.size() + end.size();
    if (count == 0) return whole_;
    HandlerSlots::yield();
    const auto share = quota_.take(more, request_.client);
    std::string chunk;
    chunk.reserve(count);
    chunk.append(bytes).append(more).append(end);
    return whole_ = whole_ && sink_.write(chunk.data(), chunk.size()) && connection_.flush();
  }
  bool whole() const { return whole_ && !request_.gone.stop_requested(); }

 private:
  httplib::DataSink& sink_;
  Connection& connection_;
  ResponseQuota& quota_;
  const Request& request_;
  bool whole_ = true;  // all writes succeeded
};

}  // namespace

// A request in the handler: a disconnect requests a stop, and the handler holds a slot.
struct Session::Work {
  Work(SessionServices& services, Connection& connection, const std::string& client, bool probes)
      : gone(connection.begin_request(client)),
        watching(services.monitor.watch(connection.fd(), gone, probes)) {}

  const std::stop_source gone;
  HangupMonitor::Registration watching;
  std::optional<HandlerSlots::Handler> handler;
};

// A request and its response.
struct Session::Exchange {
  Exchange(ByteQuota& bodies, const std::string& network) : body(bodies, network) {}

  Request request;
  std::string client;  // by address; a token may replace it in `request`
  bool head_only = false;
  int minor_version = 1;
  bool keep_alive = false;
  HttpServer::Admitted admitted;
  std::optional<Response> response;
  ByteQuota::Share body;  // charged while the body is used
  std::optional<Work> work;
  ResponseQuota::Share sent;

  // Whether the response has a body, possibly an empty one.
  bool has_body() const { return !head_only && may_have_body(response->status); }
};

Session::Session(SessionServices& services, Connection& connection)
    : services_(services), connection_(connection) {
  svr_sock_ = connection.fd();  // cpp-httplib writes bodies while this is a socket
  set_pre_routing_handler(
      [this](const httplib::Request&, httplib::Response& raw) { return answer_without_body(raw); });
  Post(kPath, [this](const httplib::Request&, httplib::Response& raw, const httplib::ContentReader& reader) {
    answer_with_body(raw, reader);
  });
  set_post_routing_handler([this](const httplib::Request&, httplib::Response& raw) { finish_headers(raw); });
}

Session::~Session() = default;

bool Session::exchange() {
  exchange_ = std::make_unique<Exchange>(services_.bodies, connection_.network());
  Request& request = exchange_->request;
  request.start = std::chrono::steady_clock::now();
  request.id = make_request_id();
  try {
    connection_.read_head();
  } catch (const HttpError&) {
    return !connection_.is_disconnected() && reject_head(std::current_exception());
  }
  const std::uint64_t before = connection_.bytes_written();
  bool closes = false;  // unused: finish_headers() sets Connection; `true` below saves a Keep-Alive header
  const bool written =
      process_request(connection_, true, closes, [this](httplib::Request& raw) { begin(raw); }) &&
      connection_.flush();
  if (!exchange_->response) {  // cpp-httplib answered by itself: check_head() lacks a rule of it
    exchange_->response = Response{.status = 400, .note = "request rejected by cpp-httplib"};
    exchange_->keep_alive = false;
  }
  Response& response = *exchange_->response;
  exchange_->work.reset();    // frees the slot
  response.stream = nullptr;  // may wait for threads of the stream
  // A client that disconnects after the last byte has received the whole response.
  const bool gone =
      connection_.is_disconnected() || response.status == kClientGone || (!written && response.note.empty());
  services_.handler.served(request, response, connection_.bytes_written() - before, gone);
  const bool keep_alive = written && exchange_->keep_alive;
  exchange_.reset();
  return keep_alive;
}

bool Session::reject_head(std::exception_ptr error) {
  const Response response = services_.handler.refuse(exchange_->request, error);
  const std::string bytes = raw_response(response);
  const std::uint64_t before = connection_.bytes_written();
  connection_.write(bytes.data(), bytes.size());
  connection_.flush();
  services_.handler.served(exchange_->request, response, connection_.bytes_written() - before,
                           connection_.is_disconnected());
  exchange_.reset();
  return false;
}

void Session::begin(httplib::Request& raw) {
  Exchange& now = *exchange_;
  now.head_only = raw.method == "HEAD";
  now.minor_version = raw.version == "HTTP/1.0" ? 0 : 1;
  const std::string expect = raw.get_header_value("Expect");
  try {
    read_request_into(now.request, raw, connection_.peer(), services_.forwarding);
    now.keep_alive = keeps_alive(now.request.headers, now.minor_version);
    now.client = now.request.client;
    now.admitted = services_.handler.admit(now.request);
    if (now.admitted.body) connection_.begin_body(*now.admitted.body);
    if (now.admitted.body && !expect.empty() && !equal_ignoring_case(expect, "100-continue"))
      throw HttpError(417, "Expect must be 100-continue (got " + expect.substr(0, 40) + ")");
  } catch (...) {
    now.response = services_.handler.refuse(now.request, std::current_exception());
  }
  raw.path = kPath;
  if (now.admitted.body) raw.method = "POST";
  // cpp-httplib would act upon other headers: it would compress responses again, decompress bodies without a
  // limit, and parse forms.
  std::erase_if(raw.headers, [](const auto& field) { return !is_framing_header(field.first); });
  // A client waits for 100 Continue only if it has not sent the body yet (RFC 9110, 10.1.1).
  const bool reads = !now.response && now.admitted.body && connection_.body_unread();
  if (reads && !expect.empty() && now.minor_version == 1 && !connection_.has_received_more())
    raw.set_header("Expect", "100-continue");
}

Session::HandlerResponse Session::answer_without_body(httplib::Response& raw) {
  if (!exchange_->response) {
    if (exchange_->admitted.body) return HandlerResponse::Unhandled;
    answer();
  }
  respond(raw);
  return HandlerResponse::Handled;
}

void Session::answer_with_body(httplib::Response& raw, const httplib::ContentReader& reader) {
  try {
    exchange_->request.body = read_body(reader);
    answer();
  } catch (...) {
    exchange_->response = services_.handler.refuse(exchange_->request, std::current_exception());
  }
  respond(raw);
}

Body Session::read_body(const httplib::ContentReader& reader) {
  std::string bytes;
  const bool whole = reader([&](const char* more, std::size_t count) {
    bytes.append(more, count);
    exchange_->body.grow(bytes.size());  // charges bytes as they arrive, not the announced length
    return true;
  });
  if (!whole) connection_.rethrow_read_error();
  return Body(std::move(bytes));
}

void Session::answer() {
  Exchange& now = *exchange_;
  try {
    const bool probes = now.minor_version == 1;  // HTTP/1.0 has no interim responses
    now.work.emplace(services_, connection_, now.client, probes);
    now.request.gone = now.work->gone.get_token();
    now.work->handler.emplace(services_.slots, now.client, now.request.gone, connection_.waiting());
    now.response = now.admitted.answer(now.request);
  } catch (...) {
    now.response = refuse(std::current_exception());
  }
  if (now.work) now.work->watching.stop_probing();
}

Response Session::refuse(std::exception_ptr error) const {
  if (connection_.is_evicted())
    error = std::make_exception_ptr(ClientLimitExceeded(
        "other clients need a connection, and this client has the most (connections)", 1, "connections"));
  return services_.handler.refuse(exchange_->request, error);
}

void Session::respond(httplib::Response& raw) {
  Exchange& now = *exchange_;
  try {
    if (now.has_body()) now.sent = services_.responses.take(now.response->body, now.request.client);
  } catch (const Busy&) {
    now.response = services_.handler.refuse(now.request, std::current_exception());
  }
  const Response& response = *now.response;
  const bool ends_with_it = response.stream && now.minor_version == 0;  // HTTP/1.0 has no chunks
  if (ends_with_it || services_.draining || connection_.body_unread() || connection_.is_evicted())
    now.keep_alive = false;
  raw.status = response.status;
  std::string type;
  const bool sends =
      response.stream ? now.has_body() : may_have_body(response.status) && !response.body.empty();
  for (const auto& [name, value] : response.headers) {
    if (sends && equal_ignoring_case(name, "Content-Type"))
      type = header_value(value);  // set with the body
    else
      raw.headers.emplace(name, header_value(value));
  }
  if (!sends) return;
  if (!response.stream)
    raw.set_content_provider(
        response.body.size(), type,
        [body = response.body](std::size_t offset, std::size_t count, httplib::DataSink& sink) {
          return sink.write(body.data() + offset, count);
        });
  else if (now.minor_version == 1)
    raw.set_chunked_content_provider(
        type, [this](std::size_t, httplib::DataSink& sink) { return stream_to(sink); });
  else
    raw.set_content_provider(type, [this](std::size_t, httplib::DataSink& sink) { return stream_to(sink); });
}

bool Session::stream_to(httplib::DataSink& sink) {
  Exchange& now = *exchange_;
  BodySink body(sink, connection_, services_.responses, now.request);
  try {
    now.response->stream(body);
  } catch (const std::exception& error) {
    now.response->note = error.what();
    if (now.minor_version == 0) connection_.reset_on_close();  // a normal end would complete the body
    return false;
  }
  sink.done();
  return body.whole();
}

void Session::finish_headers(httplib::Response& raw) const {
  const Exchange& now = *exchange_;
  for (const char* added : {"Keep-Alive", "Accept-Ranges", "Connection"}) raw.headers.erase(added);
  if (!now.keep_alive || !now.response)
    raw.set_header("Connection", "close");
  else if (now.minor_version == 0)
    raw.set_header("Connection", "keep-alive");
  if (!now.response) return;
  // A route may answer HEAD without creating the body. Its length is then unknown, not 0.
  if (!may_have_body(raw.status) || now.response->stream || (now.head_only && now.response->body.empty()))
    raw.headers.erase("Content-Length");
}

}  // namespace orrery
