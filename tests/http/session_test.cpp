#include "server/http/session.h"

#include <gtest/gtest.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>
#include <thread>

// Tests the bytes of responses.
namespace orrery {
namespace {

struct Framing {
  bool head_only = false;  // the request is HEAD
  int minor_version = 1;   // HTTP version of the request
  bool keep_alive = true;  // the client keeps the connection
};

// Session that answers one request with a given response. The test reads its socket.
class Wire {
 public:
  // `send_buffer` is the size of the kernel's send buffer in bytes, or 0 for its default.
  explicit Wire(Response response, const Framing& framing = {}, int send_buffer = 0)
      : response_(std::move(response)) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends) != 0)
      throw std::runtime_error("socketpair");
    if (send_buffer > 0) setsockopt(ends[0], SOL_SOCKET, SO_SNDBUF, &send_buffer, sizeof send_buffer);
    connection_.emplace(ends[0], IpAddress(), wake_, Timeouts{});
    reader_ = ends[1];
    const std::string request = std::string(framing.head_only ? "HEAD" : "GET") + " / HTTP/1." +
                                std::to_string(framing.minor_version) + "\r\nHost: x\r\nConnection: " +
                                (framing.keep_alive ? "keep-alive" : "close") + "\r\n\r\n";
    EXPECT_EQ(send(reader_, request.data(), request.size(), 0), static_cast<ssize_t>(request.size()));
  }
  ~Wire() {
    hang_up();
    connection_.reset();
    close(wake_);
  }
  Wire(const Wire&) = delete;

  // Serves the request and closes the connection. Returns whether the connection could stay open.
  bool serve() {
    bool open = false;
    {
      Session session(services_, *connection_);
      open = connection_->wait_for_request() && session.exchange();
    }
    connection_.reset();
    return open;
  }
  void hang_up() {
    if (reader_ >= 0) close(reader_);
    reader_ = -1;
  }
  // Receives until the connection ends.
  std::string receive_all() const {
    std::string all;
    std::string bytes(5000, '\0');
    for (ssize_t count; (count = recv(reader_, bytes.data(), bytes.size(), 0)) != 0;)
      if (count > 0)
        all.append(bytes, 0, static_cast<std::size_t>(count));
      else
        std::this_thread::yield();
    return all;
  }
  const std::string& note() const { return note_; }

 private:
  const Response response_;
  std::string note_;  // Response::note, once it is sent
  const HttpServer::Handler handler_{
      .admit = [this](Request&) -> HttpServer::Admitted {
        return {.body = std::nullopt, .answer = [this](Request&) { return response_; }};
      },
      .refuse = [](const Request&, std::exception_ptr) { return Response{.status = 500}; },
      .served = [this](const Request&, const Response& response, std::uint64_t,
                       bool) { note_ = response.note; },
      .grace_over = [] {}};
  HangupMonitor monitor_;
  SessionServices services_{{.max_answers = 8 << 20}, handler_, monitor_};
  const int wake_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  int reader_ = -1;
  std::optional<Connection> connection_;
};

std::string written(Response response, const Framing& framing = {}) {
  Wire wire(std::move(response), framing);
  wire.serve();
  return wire.receive_all();
}

Response stream_of(const std::vector<std::string>& parts) {
  Response response;
  response.set("Content-Type", "text/plain");
  response.stream = [parts](Sink& sink) {
    for (const std::string& part : parts) sink.write(part);
  };
  return response;
}

TEST(Session, WritesBodyAfterHeadersAndLength) {
  EXPECT_EQ(written(text_response(200, "text/plain", "body")),
            "HTTP/1.1 200 OK\r\nContent-Length: 4\r\nContent-Type: text/plain\r\n\r\nbody");
  EXPECT_EQ(written(text_response(404, "text/plain", ""), {.keep_alive = false}),
            "HTTP/1.1 404 Not Found\r\nConnection: close\r\nContent-Length: 0\r\n"
            "Content-Type: text/plain\r\n\r\n");
  EXPECT_EQ(written(text_response(200, "text/plain", "b"), {.minor_version = 0}),
            "HTTP/1.1 200 OK\r\nConnection: keep-alive\r\nContent-Length: 1\r\n"
            "Content-Type: text/plain\r\n\r\nb");
}

TEST(Session, OmitsBodyWhereForbidden) {  // RFC 9110, 6.4.1 and 9.3.2
  EXPECT_EQ(written({.status = 204, .body = "x"}), "HTTP/1.1 204 No Content\r\n\r\n");
  EXPECT_EQ(written({.status = 304, .body = "x"}), "HTTP/1.1 304 Not Modified\r\n\r\n");
  EXPECT_EQ(written({.status = 304, .stream = stream_of({"x"}).stream}), "HTTP/1.1 304 Not Modified\r\n\r\n");
  EXPECT_EQ(written(text_response(200, "text/plain", "four"), {.head_only = true}),
            "HTTP/1.1 200 OK\r\nContent-Length: 4\r\nContent-Type: text/plain\r\n\r\n");
  EXPECT_EQ(written({}, {.head_only = true}), "HTTP/1.1 200 OK\r\n\r\n");  // the length is unknown
  EXPECT_EQ(written(stream_of({"x"}), {.head_only = true}),
            "HTTP/1.1 200 OK\r\nContent-Type: text/plain\r\n\r\n");
}

TEST(Session, WritesPartsAsChunks) {  // RFC 9112, 7.1
  const std::string chunks = written(stream_of({"one", "", std::string(26, 'z')}));
  EXPECT_EQ(
      chunks,
      "HTTP/1.1 200 OK\r\nContent-Type: text/plain\r\nTransfer-Encoding: chunked\r\n\r\n3\r\none\r\n1a\r\n" +
          std::string(26, 'z') + "\r\n0\r\n\r\n");
  EXPECT_EQ(written(stream_of({"one", "two"}), {.minor_version = 0, .keep_alive = false}),
            "HTTP/1.1 200 OK\r\nConnection: close\r\nContent-Type: text/plain\r\n\r\nonetwo");
}

TEST(Session, PreventsHeaderInjection) {
  Response response;
  response.set("Location",
               "/a\r\nSet-Cookie: b\n\x01\x7f"
               "c");
  EXPECT_EQ(written(std::move(response)),
            "HTTP/1.1 200 OK\r\nContent-Length: 0\r\nLocation: /a  Set-Cookie: b   c\r\n\r\n");
}

TEST(Session, WritesLongResponsesThroughSmallBuffer) {
  std::string body(1'000'003, '\0');
  for (std::size_t i = 0; i < body.size(); ++i) body[i] = static_cast<char>(i * 2654435761U >> 24);
  for (const bool streamed : {false, true}) {
    Wire wire(streamed ? stream_of({body, body}) : text_response(200, "application/octet-stream", body), {},
              4096);
    bool open = false;
    std::thread writer([&] { open = wire.serve(); });
    const std::string all = wire.receive_all();
    writer.join();
    EXPECT_TRUE(open);
    const std::string chunk = "f4243\r\n" + body + "\r\n";
    const std::string wanted = streamed ? chunk + chunk + "0\r\n\r\n" : body;
    EXPECT_TRUE(all.substr(all.find("\r\n\r\n") + 4) == wanted) << all.size();
  }
}

TEST(Session, AbortsFailedStream) {
  Response response;
  response.stream = [](Sink& sink) {
    sink.write("part");
    throw std::runtime_error("no more");
  };
  Wire wire(std::move(response));
  EXPECT_FALSE(wire.serve());
  EXPECT_EQ(wire.note(), "no more");
  EXPECT_TRUE(wire.receive_all().ends_with("\r\n\r\n4\r\npart\r\n"));  // without the last chunk
}

TEST(Session, ReportsDisconnectToStream) {
  Response response;
  int taken = 0;
  response.stream = [&](Sink& sink) { taken = sink.write("a") + sink.write("b"); };
  Wire wire(std::move(response));
  wire.hang_up();
  EXPECT_FALSE(wire.serve());
  EXPECT_EQ(taken, 0);
  EXPECT_TRUE(wire.note().empty());
}

}  // namespace
}  // namespace orrery
