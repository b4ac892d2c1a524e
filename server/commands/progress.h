#pragma once

#include <chrono>
#include <mutex>
#include <string>

namespace orrery {

// A line on the terminal that says how far the work is and how long it will take. Silent where standard error
// is no terminal. Safe to update from several threads at once.
class ProgressBar {
 public:
  explicit ProgressBar(std::string unit);  // what is counted: "tiles"
  ~ProgressBar();                          // takes the line away

  // What is done before there is anything to count.
  void say(const std::string& what);
  void update(int done, int total);

 private:
  const std::string unit_;
  const bool shown_;
  const std::chrono::steady_clock::time_point start_;
  std::mutex mutex_;  // guards what follows, and the line
  bool written_ = false;
  int done_ = 0;
  std::chrono::steady_clock::time_point drawn_;
};

}  // namespace orrery
