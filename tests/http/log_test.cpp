#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "tests/http/daemon.h"

// Tests that the service keeps running if its log is blocked or closed.
namespace orrery {
namespace {

struct LogPipe {
  LogPipe() { EXPECT_EQ(pipe2(ends, O_CLOEXEC), 0); }
  ~LogPipe() {
    close_reader();
    close(ends[1]);
  }
  void close_reader() {
    if (ends[0] >= 0) close(ends[0]);
    ends[0] = -1;
  }
  bool is_full() const {
    pollfd ready{ends[1], POLLOUT, 0};
    return poll(&ready, 1, 0) == 0;
  }
  int ends[2];
};

constexpr int kMany = 1000;  // lines of 200 bytes or more, three times the capacity of a pipe

void expect_answers(const Daemon& daemon, int count) {
  httplib::Client client = daemon.client();
  const std::string path = "/v1/limits/" + std::string(200, 'x');
  for (int i = 0; i < count; ++i) {
    const auto result = client.Get(path);
    ASSERT_TRUE(result) << i;
    EXPECT_EQ(result->status, 404);
  }
}

TEST(LogPipe, DoesNotBlockRequestsOrShutdownWhenFull) {
  const LogPipe pipe;
  Daemon daemon({}, pipe.ends[1]);
  expect_answers(daemon, kMany);
  EXPECT_TRUE(pipe.is_full());
  while (daemon.metric("orrery_log_lines_dropped_total") == 0)  // the first line waits for a reader
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0);
}

TEST(LogPipe, KeepsServiceRunningAfterReaderCloses) {
  LogPipe pipe;
  Daemon daemon({}, pipe.ends[1]);
  pipe.close_reader();
  expect_answers(daemon, 10);
  EXPECT_TRUE(daemon.running());
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0);
}

}  // namespace
}  // namespace orrery
