#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "server/http/session.h"
#include "server/routes/problem.h"
#include "server/routes/router.h"

// Fuzzes one HTTP connection. The client sends any bytes and then closes its side. The output must consist of
// complete responses of the service, even if the bytes try to inject a response.

namespace {

using namespace orrery;

void require(bool holds) {
  if (!holds) std::abort();
}

Router make_router() {
  const RouteBody body{.limit = {1000, "limit"}, .require = [](const Request&) {}};
  Router router;
  router.add("GET", "/", Scope::none, LogLevel::info,
             [](Request&) { return text_response(200, "text/plain", "root"); });
  router.add("POST", "/a/{b}", Scope::none, LogLevel::info, body, [](Request& request) {
    return text_response(200, "text/plain", std::to_string(request.body.size()) + request.path_value("b"));
  });
  router.add("GET", "/stream", Scope::none, LogLevel::info, [](Request&) {
    Response response;
    response.set("Content-Type", "text/plain");
    response.stream = [](Sink& sink) { sink.write("part"); };
    return response;
  });
  return router;
}

HttpServer::Handler make_handler(const Router& router) {
  const auto with_id = [](const Request& request, Response response) {
    response.set("X-Request-ID", request.id);
    return response;
  };
  return {.admit = [&router, with_id](Request& request) -> HttpServer::Admitted {
            const Route& route = router.find(request);
            return {.body = route.body ? std::optional(route.body->limit) : std::nullopt,
                    .answer = [&route, with_id](Request& r) { return with_id(r, route.handler(r)); }};
          },
          .refuse =
              [with_id](const Request& request, std::exception_ptr error) {
                return with_id(request, problem_response(error, request.id));
              },
          .served = [](const Request&, const Response& response, std::uint64_t,
                       bool) { require(response.status != 500); },
          .grace_over = [] {}};
}

// Aborts unless `bytes` consists of complete responses with known headers, each with a body of the stated
// length.
void check_answers(std::string_view bytes) {
  while (!bytes.empty()) {
    require(bytes.starts_with("HTTP/1.1 "));
    if (bytes.starts_with("HTTP/1.1 100 Continue\r\n\r\n")) {
      bytes.remove_prefix(25);
      continue;
    }
    const std::size_t end = bytes.find("\r\n\r\n");
    require(end != std::string_view::npos);
    const std::string head(bytes.substr(0, end + 2));
    bytes.remove_prefix(end + 4);
    require(head.find("\r\nX-Request-ID: ") != std::string::npos);
    require(head.find("\r\nInjected") == std::string::npos);
    if (head.find("\r\nTransfer-Encoding: chunked\r\n") != std::string::npos) {
      if (bytes == "4\r\npart\r\n") return;  // cut off: a half-closed client counts as disconnected
      if (!bytes.starts_with("4\r\npart\r\n0\r\n\r\n")) continue;  // HEAD
      bytes.remove_prefix(14);
      continue;
    }
    const std::size_t at = head.find("\r\nContent-Length: ");
    if (at == std::string::npos) {
      // An HTTP/1.0 body extends to the end of the connection.
      if (bytes.starts_with("part")) bytes.remove_prefix(4);
      continue;
    }
    const std::size_t length = std::strtoul(head.c_str() + at + 18, nullptr, 10);
    // A response to HEAD has no body, so the next response follows its header.
    if (bytes.starts_with("HTTP/1.1 ")) continue;
    if (bytes.empty()) return;  // the last response, to HEAD
    require(length <= bytes.size());
    bytes.remove_prefix(length);
  }
}

std::string received_from(int fd) {
  std::string all;
  char bytes[64 * 1024];
  for (ssize_t count; (count = recv(fd, bytes, sizeof bytes, MSG_DONTWAIT)) > 0;)
    all.append(bytes, static_cast<std::size_t>(count));
  return all;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Router router = make_router();
  static const HttpServer::Handler handler = make_handler(router);
  static HangupMonitor monitor;
  static SessionServices services({.max_bodies = 2000}, handler, monitor);
  static const int wake = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  constexpr std::size_t kMost = 20'000;
  int ends[2];
  require(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends) == 0);
  size = std::min(size, kMost);
  require(send(ends[0], data, size, MSG_NOSIGNAL) == static_cast<ssize_t>(size));
  shutdown(ends[0], SHUT_WR);
  {
    Connection connection(ends[1], IpAddress(), wake, Timeouts{});
    Session session(services, connection);
    while (connection.wait_for_request() && session.exchange())
      ;
    connection.linger();
  }
  check_answers(received_from(ends[0]));
  close(ends[0]);
  return 0;
}
