#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <string_view>

namespace orrery {

// Writes lines to a file descriptor without waiting long for its reader, who may be slow or gone. For one
// thread at a time, except close_by().
class LineWriter {
 public:
  explicit LineWriter(int fd);
  ~LineWriter();
  LineWriter(const LineWriter&) = delete;

  // Whether the line was written, or begun: the next call then writes the rest. Waits at most 100 ms, and not
  // at all while the reader does not read; the line is then dropped.
  bool write(std::string_view line);

  // Waits for the reader until then at the latest.
  void close_by(std::chrono::steady_clock::time_point end) { close_by_ = end; }

 private:
  bool wait_until_writable(std::chrono::steady_clock::time_point until) const;
  void write_rest();

  const int fd_;
  std::string rest_;      // of a line that was begun
  bool stalled_ = false;  // the reader did not read when it was last waited for
  std::atomic<std::chrono::steady_clock::time_point> close_by_{std::chrono::steady_clock::time_point::max()};
};

}  // namespace orrery
