#include "server/telemetry/metrics.h"

#include <prometheus/counter.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "server/telemetry/service_counters.h"

namespace orrery {
namespace {

using prometheus::Counter;
using prometheus::Histogram;

}  // namespace

struct Metrics::Families {
  prometheus::Registry registry;
  prometheus::Family<Counter>& requests = prometheus::BuildCounter()
                                              .Name("orrery_requests_total")
                                              .Help("Requests by route, method and status")
                                              .Register(registry);
  prometheus::Family<Histogram>& seconds =
      prometheus::BuildHistogram()
          .Name("orrery_request_seconds")
          .Help("Time from the first byte of a request to the last byte of its response")
          .Register(registry);
  prometheus::Family<Counter>& refusals =
      prometheus::BuildCounter()
          .Name("orrery_rejected_requests_total")
          .Help("Rejected requests by exceeded limit, or draining during shutdown")
          .Register(registry);
  Counter& sent_bytes = prometheus::BuildCounter()
                            .Name("orrery_sent_bytes_total")
                            .Help("Bytes sent in responses, including headers")
                            .Register(registry)
                            .Add({});
  Counter& clients_left = prometheus::BuildCounter()
                              .Name("orrery_clients_left_total")
                              .Help("Requests whose client disconnected before the end of the response")
                              .Register(registry)
                              .Add({});
};

Metrics::Metrics() : families_(std::make_unique<Families>()) {}
Metrics::~Metrics() = default;

void Metrics::count_request(std::string_view route, std::string_view method, int status, double seconds,
                            std::uint64_t bytes, bool client_left) {
  constexpr std::array<std::string_view, 6> kMethods{"GET", "HEAD", "POST", "PUT", "DELETE", "OPTIONS"};
  const bool known = std::find(kMethods.begin(), kMethods.end(), method) != kMethods.end();
  const std::string name(route.empty() ? "none" : route), verb(known ? method : "other");
  families_->requests.Add({{"route", name}, {"method", verb}, {"code", std::to_string(status)}}).Increment();
  families_->seconds.Add({{"route", name}}, SecondsHistogram::boundaries()).Observe(seconds);
  families_->sent_bytes.Increment(static_cast<double>(bytes));
  if (client_left) families_->clients_left.Increment();
}

void Metrics::count_refusal(std::string_view reason) {
  families_->refusals.Add({{"reason", std::string(reason)}}).Increment();
}

std::string Metrics::text(std::vector<prometheus::MetricFamily> more) const {
  auto families = families_->registry.Collect();
  std::move(more.begin(), more.end(), std::back_inserter(families));
  return prometheus::TextSerializer().Serialize(families);
}

}  // namespace orrery
