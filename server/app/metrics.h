#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

namespace orrery {

// What is true of the service at one moment.
struct Readings {
  bool ready = false;
  int renders_running = 0, renders_waiting = 0;
  std::size_t orbits = 0, jobs = 0, connections = 0;
  std::uint64_t connections_refused = 0, rays = 0;  // since the start
  std::size_t scene_bytes = 0, asset_bytes = 0, picture_bytes = 0, job_bytes = 0;
};

// Counts for Prometheus. Safe from any thread.
class Metrics {
 public:
  Metrics();
  ~Metrics();

  // An answered request. `route`: the pattern that it matched, so that there are few.
  void count_request(std::string_view route, std::string_view method, int status, double seconds,
                     bool client_left);

  // All in Prometheus' text format, version 0.0.4.
  std::string text(const Readings& readings) const;

 private:
  struct Families;
  std::unique_ptr<Families> families_;
  mutable std::mutex reading_;  // one at a time brings gauges up to date
};

}  // namespace orrery
