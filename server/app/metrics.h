#pragma once

#include <prometheus/metric_family.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace orrery {

// Counts of requests and answers, and the text that Prometheus reads. Safe from any thread.
class Metrics {
 public:
  Metrics();
  ~Metrics();

  // An answered request. `route`: the pattern that it matched, so that there are few. `bytes`: sent.
  void count_request(std::string_view route, std::string_view method, int status, double seconds,
                     std::uint64_t bytes, bool client_left);

  // A request that was understood but refused: by the limit of that name, or as the service ends
  // ("draining").
  void count_refusal(std::string_view reason);

  // These counts and `more` in Prometheus' text format, version 0.0.4.
  std::string text(std::vector<prometheus::MetricFamily> more) const;

 private:
  struct Families;
  std::unique_ptr<Families> families_;
};

}  // namespace orrery
