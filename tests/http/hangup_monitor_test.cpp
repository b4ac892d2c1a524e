#include "server/http/hangup_monitor.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <future>
#include <optional>

// Tests detection of disconnected clients.
namespace orrery {
namespace {

constexpr bool kSendsProbes = true;

// Both ends of a connection.
struct Pair {
  Pair() { socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends); }
  ~Pair() {
    close(ends[0]);
    hang_up();
  }
  void hang_up() {
    if (ends[1] >= 0) close(ends[1]);
    ends[1] = -1;
  }
  int ends[2];
};

// Notification of a stop request.
struct StopNotification {
  std::stop_source source;
  std::promise<void> promise;
  std::future<void> future = promise.get_future();
  std::stop_callback<std::function<void()>> callback{source.get_token(), [this] { promise.set_value(); }};
};

// Work for one connection that the monitor watches.
struct WatchedConnection {
  explicit WatchedConnection(bool asks) : watching(monitor.watch(pair.ends[0], told.source, asks)) {}
  HangupMonitor monitor;
  Pair pair;
  StopNotification told;
  HangupMonitor::Registration watching;
};

TEST(HangupMonitor, StopsWorkOnHangup) {
  HangupMonitor monitor;
  Pair stays, leaves;
  StopNotification staying, leaving;
  const auto first = monitor.watch(stays.ends[0], staying.source, kSendsProbes);
  const auto second = monitor.watch(leaves.ends[0], leaving.source, kSendsProbes);
  leaves.hang_up();
  leaving.future.wait();
  EXPECT_FALSE(staying.source.stop_requested());
}

TEST(HangupMonitor, StopsWorkOnHalfCloseWithoutProbes) {
  WatchedConnection work(!kSendsProbes);
  EXPECT_EQ(write(work.pair.ends[1], "bytes", 5), 5);  // data is not a disconnect
  shutdown(work.pair.ends[1], SHUT_WR);
  work.told.future.wait();
}

TEST(HangupMonitor, ProbesHalfClosedConnections) {
  WatchedConnection work(kSendsProbes);
  shutdown(work.pair.ends[1], SHUT_WR);
  std::array<char, 100> bytes;
  const ssize_t count = read(work.pair.ends[1], bytes.data(), bytes.size());
  EXPECT_EQ(std::string(bytes.data(), static_cast<std::size_t>(count)), "HTTP/1.1 100 Continue\r\n\r\n");
  EXPECT_FALSE(work.told.source.stop_requested());
  work.pair.hang_up();
  work.told.future.wait();
}

// A relay may need several probes before it detects the disconnect.
TEST(HangupMonitor, RepeatsProbes) {
  WatchedConnection work(kSendsProbes);
  shutdown(work.pair.ends[1], SHUT_WR);
  const std::string once = "HTTP/1.1 100 Continue\r\n\r\n";
  std::string all(3 * once.size(), ' ');
  EXPECT_EQ(recv(work.pair.ends[1], all.data(), all.size(), MSG_WAITALL), static_cast<ssize_t>(all.size()));
  EXPECT_EQ(all, once + once + once);
}

TEST(HangupMonitor, StopsProbingOnceResponseBegins) {
  WatchedConnection work(kSendsProbes);
  work.watching.stop_probing();
  shutdown(work.pair.ends[1], SHUT_WR);
  work.told.future.wait();
  char byte;
  EXPECT_EQ(recv(work.pair.ends[1], &byte, 1, MSG_DONTWAIT), -1);
}

TEST(HangupMonitor, DetectsHangupBeforeRegistration) {
  HangupMonitor monitor;
  Pair pair;
  pair.hang_up();
  StopNotification told;
  const auto watching = monitor.watch(pair.ends[0], told.source, kSendsProbes);
  told.future.wait();
}

// A keep-alive connection has many requests in sequence. A disconnect stops only the current one.
TEST(HangupMonitor, StopsOnlyCurrentWork) {
  HangupMonitor monitor;
  Pair pair;
  StopNotification before, now;
  { const auto watching = monitor.watch(pair.ends[0], before.source, kSendsProbes); }
  const auto watching = monitor.watch(pair.ends[0], now.source, kSendsProbes);
  pair.hang_up();
  now.future.wait();
  EXPECT_FALSE(before.source.stop_requested());
}

}  // namespace
}  // namespace orrery
