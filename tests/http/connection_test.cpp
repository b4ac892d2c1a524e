#include "server/http/connection.h"

#include <gtest/gtest.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>
#include <thread>

// Tests the minimum transfer rate with clients that send or read single bytes slowly.
namespace orrery {
namespace {

constexpr Timeouts kBrief{.bytes_per_s = 1000, .window = std::chrono::seconds(1)};

// Connection whose client sends or reads one byte every 5 ms.
class Trickle {
 public:
  explicit Trickle(const std::string& head) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends) != 0)
      throw std::runtime_error("socketpair");
    client_ = ends[1];
    EXPECT_EQ(send(client_, head.data(), head.size(), MSG_NOSIGNAL), static_cast<ssize_t>(head.size()));
    connection_.emplace(ends[0], IpAddress(), wake_, kBrief);
    thread_ = std::jthread([this](const std::stop_token& stop) {
      for (char byte = ' '; !stop.stop_requested();
           std::this_thread::sleep_for(std::chrono::milliseconds(5))) {
        [[maybe_unused]] const ssize_t sent = send(client_, &byte, 1, MSG_NOSIGNAL);
        [[maybe_unused]] const ssize_t received = recv(client_, &byte, 1, 0);
      }
    });
  }
  ~Trickle() {
    thread_ = {};
    connection_.reset();
    close(client_);
    close(wake_);
  }
  Trickle(const Trickle&) = delete;
  Connection& connection() { return *connection_; }

 private:
  const int wake_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  int client_ = -1;
  std::optional<Connection> connection_;
  std::jthread thread_;
};

void expect_too_slow(const std::string& framing, const std::string& begin) {
  Trickle trickle("POST / HTTP/1.1\r\nHost: x\r\n" + framing + "\r\n\r\n" + begin);
  Connection& connection = trickle.connection();
  ASSERT_TRUE(connection.wait_for_request());
  connection.read_head();
  connection.begin_body({1'000'000, "max_request_body_bytes"});
  std::string bytes(1000, '\0');
  while (connection.read(bytes.data(), bytes.size()) > 0) {
  }
  try {
    connection.rethrow_read_error();
  } catch (const HttpError& error) {
    EXPECT_EQ(error.status(), 408) << error.what();
  }
}

TEST(Trickle, TimesOutSlowRequestBodies) {
  expect_too_slow("Content-Length: 1000000", "");
  expect_too_slow("Transfer-Encoding: chunked", "10000\r\n");
}

TEST(Trickle, TimesOutSlowResponses) {
  Trickle trickle("");
  const std::string bytes(10'000'000, 'a');
  EXPECT_EQ(trickle.connection().write(bytes.data(), bytes.size()), -1);
}

}  // namespace
}  // namespace orrery
