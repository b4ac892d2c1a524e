#include "server/http/response_writer.h"

#include <gtest/gtest.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>
#include <thread>

// Tests serialization of responses.
namespace orrery {
namespace {

// Connection to a socket that the test reads.
class Wire {
 public:
  Wire() : Wire(0) {}
  // `send_buffer` is the size of the kernel's send buffer in bytes, or 0 for its default.
  explicit Wire(int send_buffer) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends) != 0)
      throw std::runtime_error("socketpair");
    if (send_buffer > 0) setsockopt(ends[0], SOL_SOCKET, SO_SNDBUF, &send_buffer, sizeof send_buffer);
    connection_.emplace(ends[0], IpAddress(), wake_, Timeouts{});
    reader_ = ends[1];
  }
  ~Wire() {
    hang_up();
    connection_.reset();
    close(wake_);
  }
  Wire(const Wire&) = delete;

  Connection& connection() { return *connection_; }
  Sender sender() { return {answers_, "client"}; }
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
  void end() { connection_.reset(); }

 private:
  const int wake_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  ResponseQuota answers_{8 << 20};
  int reader_ = -1;
  std::optional<Connection> connection_;
};

std::string written(Response response, const Framing& framing = {}) {
  Wire wire;
  EXPECT_TRUE(write_response(wire.connection(), response, framing, wire.sender()));
  wire.end();
  return wire.receive_all();
}

Response stream_of(const std::vector<std::string>& parts) {
  Response response;
  response.stream = [parts](Sink& sink) {
    for (const std::string& part : parts) sink.write(part);
  };
  return response;
}

TEST(ResponseWriter, WritesBodyAfterHeadersAndLength) {
  EXPECT_EQ(written(text_response(200, "text/plain", "body")),
            "HTTP/1.1 200 OK\r\nContent-Type: text/plain\r\nContent-Length: 4\r\n\r\nbody");
  EXPECT_EQ(written(text_response(404, "text/plain", ""), {.keep_alive = false}),
            "HTTP/1.1 404 Not Found\r\nContent-Type: text/plain\r\nContent-Length: 0\r\nConnection: "
            "close\r\n\r\n");
  EXPECT_EQ(written(text_response(200, "text/plain", "b"), {.minor_version = 0}),
            "HTTP/1.1 200 OK\r\nContent-Type: text/plain\r\nContent-Length: 1\r\nConnection: "
            "keep-alive\r\n\r\nb");
}

TEST(ResponseWriter, OmitsBodyWhereForbidden) {  // RFC 9110, 6.4.1 and 9.3.2
  EXPECT_EQ(written({.status = 204, .body = "x"}), "HTTP/1.1 204 No Content\r\n\r\n");
  EXPECT_EQ(written({.status = 304, .body = "x"}), "HTTP/1.1 304 Not Modified\r\n\r\n");
  EXPECT_EQ(written({.status = 304, .stream = stream_of({"x"}).stream}), "HTTP/1.1 304 Not Modified\r\n\r\n");
  EXPECT_EQ(written({.body = "four"}, {.head_only = true}), "HTTP/1.1 200 OK\r\nContent-Length: 4\r\n\r\n");
  EXPECT_EQ(written({}, {.head_only = true}), "HTTP/1.1 200 OK\r\n\r\n");  // the length is unknown
  EXPECT_EQ(written(stream_of({"x"}), {.head_only = true}), "HTTP/1.1 200 OK\r\n\r\n");
}

TEST(ResponseWriter, WritesPartsAsChunks) {  // RFC 9112, 7.1
  const std::string chunks = written(stream_of({"one", "", std::string(26, 'z')}));
  EXPECT_EQ(chunks, "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n3\r\none\r\n1a\r\n" +
                        std::string(26, 'z') + "\r\n0\r\n\r\n");
  EXPECT_EQ(written(stream_of({"one", "two"}), {.minor_version = 0, .keep_alive = false}),
            "HTTP/1.1 200 OK\r\nConnection: close\r\n\r\nonetwo");
}

TEST(ResponseWriter, PreventsHeaderInjection) {
  Response response;
  response.set("Location",
               "/a\r\nSet-Cookie: b\n\x01\x7f"
               "c");
  EXPECT_EQ(written(std::move(response)),
            "HTTP/1.1 200 OK\r\nLocation: /a  Set-Cookie: b   c\r\nContent-Length: 0\r\n\r\n");
}

TEST(ResponseWriter, WritesLongResponsesThroughSmallBuffer) {
  std::string body(1'000'003, '\0');
  for (std::size_t i = 0; i < body.size(); ++i) body[i] = static_cast<char>(i * 2654435761U >> 24);
  for (const bool streamed : {false, true}) {
    Wire wire(4096);
    Response response = streamed ? stream_of({body, body}) : Response{.body = body};
    bool whole = false;
    std::thread writer([&] {
      whole = write_response(wire.connection(), response, {}, wire.sender());
      wire.end();
    });
    const std::string all = wire.receive_all();
    writer.join();
    EXPECT_TRUE(whole);
    const std::string chunk = "f4243\r\n" + body + "\r\n";
    const std::string wanted = streamed ? chunk + chunk + "0\r\n\r\n" : body;
    EXPECT_TRUE(all.substr(all.find("\r\n\r\n") + 4) == wanted) << all.size();
  }
}

TEST(ResponseWriter, AbortsFailedStream) {
  Wire wire;
  Response response;
  response.stream = [](Sink& sink) {
    sink.write("part");
    throw std::runtime_error("no more");
  };
  EXPECT_FALSE(write_response(wire.connection(), response, {}, wire.sender()));
  EXPECT_EQ(response.note, "no more");
  wire.end();
  EXPECT_TRUE(wire.receive_all().ends_with("\r\n\r\n4\r\npart\r\n"));  // without the last chunk
}

TEST(ResponseWriter, ReportsDisconnectToStream) {
  Wire wire;
  wire.hang_up();
  Response response;
  int taken = 0;
  response.stream = [&](Sink& sink) { taken = sink.write("a") + sink.write("b"); };
  EXPECT_FALSE(write_response(wire.connection(), response, {}, wire.sender()));
  EXPECT_EQ(taken, 0);
  EXPECT_TRUE(response.note.empty());
}

}  // namespace
}  // namespace orrery
