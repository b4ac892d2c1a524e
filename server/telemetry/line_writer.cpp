#include "server/telemetry/line_writer.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>

namespace orrery {

using Clock = std::chrono::steady_clock;

namespace {

// Returns a duplicate descriptor. Reopens a pipe in non-blocking mode, because changing the mode of the
// shared description would affect every process that uses the pipe.
int duplicate(int fd) {
  struct stat status {};
  if (fstat(fd, &status) == 0 && S_ISFIFO(status.st_mode)) {
    const std::string path = "/proc/self/fd/" + std::to_string(fd);
    const int own = open(path.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    if (own >= 0) return own;
  }
  return fcntl(fd, F_DUPFD_CLOEXEC, 0);
}

}  // namespace

LineWriter::LineWriter(int fd) : fd_(duplicate(fd)) {}

LineWriter::~LineWriter() {
  if (fd_ >= 0) close(fd_);
}

bool LineWriter::write(std::string_view line) {
  write_rest();
  if (!rest_.empty()) return false;
  rest_ = line;
  write_rest();
  if (rest_.size() < line.size()) return true;
  rest_.clear();
  return false;
}

bool LineWriter::wait_until_writable(Clock::time_point until) const {
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
    pollfd ready{fd_, POLLOUT, 0};
    const int count = poll(&ready, 1, static_cast<int>(std::max<std::int64_t>(left.count(), 0)));
    if (count > 0) return true;
    if (count == 0 || errno != EINTR) return false;
  }
}

// Writes at most PIPE_BUF bytes per call. A ready pipe, socket or terminal accepts that many without
// blocking.
void LineWriter::write_rest() {
  constexpr std::chrono::milliseconds kPatience{100};
  const auto now = Clock::now();
  const auto until = stalled_ ? now : std::min(now + kPatience, close_by_.load());
  std::string_view bytes = rest_;
  while (!bytes.empty()) {
    stalled_ = !wait_until_writable(until);
    if (stalled_) break;
    const ssize_t count = ::write(fd_, bytes.data(), std::min<std::size_t>(bytes.size(), PIPE_BUF));
    if (count > 0)
      bytes.remove_prefix(static_cast<std::size_t>(count));
    else if (errno == EAGAIN && Clock::now() >= until)  // another process has filled the pipe
      break;
    else if (errno != EINTR && errno != EAGAIN)  // no reader, or the disk is full
      break;
  }
  rest_.erase(0, rest_.size() - bytes.size());
}

}  // namespace orrery
