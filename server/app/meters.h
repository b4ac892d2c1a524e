#pragma once

#include <prometheus/histogram.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <string_view>

namespace orrery {

// How many things took how many seconds, in steps that tell a cached picture from a quick and from a long
// one. Safe from any thread.
class SecondsHistogram : public prometheus::Histogram {
 public:
  SecondsHistogram() : Histogram(boundaries()) {}
  static BucketBoundaries boundaries() {
    return {0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 60};
  }
};

// What the work for a request is at. A render builds its structure and traces.
enum class Stage : std::size_t { read, queue, settle, render, encode };
inline constexpr std::array<std::string_view, 5> kStages{"read", "queue", "settle", "render", "encode"};

// What is counted of the work, since the start. Safe from any thread.
struct Meters {
  const std::chrono::system_clock::time_point started = std::chrono::system_clock::now();
  std::atomic<std::uint64_t> rays{0};
  std::atomic<std::uint64_t> pictures_found{0}, pictures_made{0};  // of those asked for
  std::atomic<std::uint64_t> films_found{0};                       // of pictures made: encoded, not rendered
  std::atomic<std::uint64_t> jobs_done{0}, jobs_failed{0}, jobs_cancelled{0};
  std::array<std::atomic<std::uint64_t>, kStages.size()> given_up{};  // work before its end, by stage
  std::atomic<std::uint64_t> reloads_failed{0};                       // on SIGHUP
  SecondsHistogram render;  // of a frame: building its structure and tracing it
};

}  // namespace orrery
