#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <string_view>

namespace orrery {

// Writes lines to a file descriptor without long waits for a slow or missing reader. For one thread at a
// time, except close_by().
class LineWriter {
 public:
  explicit LineWriter(int fd);
  ~LineWriter();
  LineWriter(const LineWriter&) = delete;

  // Returns whether the line was written or begun; the next call writes the rest. Waits at most 100 ms. If
  // the reader has stalled, does not wait and drops the line.
  bool write(std::string_view line);

  // Ends all waits for the reader at `end`.
  void close_by(std::chrono::steady_clock::time_point end) { close_by_ = end; }

 private:
  bool wait_until_writable(std::chrono::steady_clock::time_point until) const;
  void write_rest();

  const int fd_;
  std::string rest_;      // rest of a partly written line
  bool stalled_ = false;  // the last wait for the reader timed out
  std::atomic<std::chrono::steady_clock::time_point> close_by_{std::chrono::steady_clock::time_point::max()};
};

}  // namespace orrery
