#pragma once

#include <prometheus/histogram.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <string_view>

namespace orrery {

// Histogram of durations in seconds. Its buckets separate cached, fast and slow renders. Thread-safe.
class SecondsHistogram : public prometheus::Histogram {
 public:
  SecondsHistogram() : Histogram(boundaries()) {}
  static BucketBoundaries boundaries() {
    return {0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 60};
  }
};

// Current stage of a request's work. `render` includes building the acceleration structure.
enum class Stage : std::size_t { read, queue, settle, render, encode };
inline constexpr std::array<std::string_view, 5> kStages{"read", "queue", "settle", "render", "encode"};

// Counters since the start. Thread-safe.
struct ServiceCounters {
  const std::chrono::system_clock::time_point started = std::chrono::system_clock::now();
  std::atomic<std::uint64_t> rays{0};
  std::atomic<std::uint64_t> pictures_found{0}, pictures_made{0};  // cached, encoded
  std::atomic<std::uint64_t> films_found{0}, films_made{0};        // cached, rendered
  std::atomic<std::uint64_t> jobs_done{0}, jobs_failed{0}, jobs_cancelled{0};
  std::array<std::atomic<std::uint64_t>, kStages.size()> cancelled{};  // aborted work by stage
  std::atomic<std::uint64_t> reloads_failed{0};                        // on SIGHUP
  SecondsHistogram render;                                             // per frame: building and tracing
};

}  // namespace orrery
