#pragma once

#include <chrono>
#include <ctime>

namespace orrery {

using Clock = std::chrono::steady_clock;

inline double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// CPU time that the calling thread has used.
inline double thread_cpu_ms() {
  std::timespec used{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return double(used.tv_sec) * 1e3 + double(used.tv_nsec) * 1e-6;
}

}  // namespace orrery
