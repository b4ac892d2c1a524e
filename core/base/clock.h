#pragma once

#include <chrono>
#include <ctime>

namespace orrery {

using Clock = std::chrono::steady_clock;

inline double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Returns the CPU time of `clock` in milliseconds. Unlike getrusage(), it includes the current time slice of
// running threads.
inline double cpu_ms_by(clockid_t clock) {
  std::timespec used{};
  clock_gettime(clock, &used);
  return double(used.tv_sec) * 1e3 + double(used.tv_nsec) * 1e-6;
}
// Return the CPU time of the calling thread and of the process, in milliseconds.
inline double thread_cpu_ms() { return cpu_ms_by(CLOCK_THREAD_CPUTIME_ID); }
inline double process_cpu_ms() { return cpu_ms_by(CLOCK_PROCESS_CPUTIME_ID); }

}  // namespace orrery
