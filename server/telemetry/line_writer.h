#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <string_view>

namespace orrery {

// Writes lines to a file descriptor without long waits for a slow or missing reader. Not thread-safe, except
// for close_by().
class LineWriter {
 public:
  explicit LineWriter(int fd);
  ~LineWriter();
  LineWriter(const LineWriter&) = delete;

  // Returns true if at least a part of the line was written. The next call then writes the remaining bytes.
  // Returns false if the line was dropped. Waits for the reader for at most 100 ms, or not at all if the last
  // wait timed out.
  bool write(std::string_view line);

  // Ends all waits for the reader at the time `end` at the latest.
  void close_by(std::chrono::steady_clock::time_point end) { close_by_ = end; }

 private:
  bool wait_until_writable(std::chrono::steady_clock::time_point until) const;
  void write_rest();

  const int fd_;
  std::string rest_;      // unwritten bytes of a partly written line
  bool stalled_ = false;  // the last wait for the reader timed out
  std::atomic<std::chrono::steady_clock::time_point> close_by_{std::chrono::steady_clock::time_point::max()};
};

}  // namespace orrery
