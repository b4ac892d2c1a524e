#pragma once

#include <prometheus/metric_family.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace orrery {

// Request counters and their text for Prometheus. Thread-safe.
class Metrics {
 public:
  Metrics();
  ~Metrics();

  // Counts an answered request. `route`: the matched pattern, which bounds the number of labels. `bytes`:
  // bytes sent.
  void count_request(std::string_view route, std::string_view method, int status, double seconds,
                     std::uint64_t bytes, bool client_left);

  // Counts a rejected request. `reason`: name of the exceeded limit, or "draining" during shutdown.
  void count_refusal(std::string_view reason);

  // Returns these counters and `more` in the Prometheus text format, version 0.0.4.
  std::string text(std::vector<prometheus::MetricFamily> more) const;

 private:
  struct Families;
  std::unique_ptr<Families> families_;
};

}  // namespace orrery
