#pragma once

#include <chrono>
#include <mutex>
#include <string>

namespace orrery {

// Terminal line with the progress and the estimated time left. Writes nothing if standard error is not a
// terminal. say() and update() are thread-safe.
class ProgressBar {
 public:
  explicit ProgressBar(std::string unit);  // unit of the count: "tiles"
  ~ProgressBar();                          // clears the line

  // Shows the current step instead of a count.
  void say(const std::string& what);
  void update(int done, int total);

 private:
  const std::string unit_;
  const bool shown_;
  const std::chrono::steady_clock::time_point start_;
  std::mutex mutex_;  // guards the members below and the line
  bool written_ = false;
  int done_ = 0;
  std::chrono::steady_clock::time_point drawn_;
};

}  // namespace orrery
