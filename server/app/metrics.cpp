#include "server/app/metrics.h"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

#include "core/base/version.h"

namespace orrery {
namespace {

using prometheus::Counter;
using prometheus::Gauge;
using prometheus::Histogram;

// Seconds, in steps that tell a cached picture from a quick and from a long one.
const Histogram::BucketBoundaries kSeconds{0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2,
                                           0.5,   1,     2,     5,    10,   20,   60};

double resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  double size = 0, resident = 0;
  statm >> size >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

double open_files() {
  std::error_code gone;
  const std::filesystem::directory_iterator files("/proc/self/fd", gone);
  return static_cast<double>(std::distance(begin(files), end(files)));
}

}  // namespace

struct Metrics::Families {
  prometheus::Registry registry;
  prometheus::Family<Counter>& requests = prometheus::BuildCounter()
                                              .Name("orrery_requests_total")
                                              .Help("Requests answered, by route, method and status")
                                              .Register(registry);
  prometheus::Family<Histogram>& seconds = prometheus::BuildHistogram()
                                               .Name("orrery_request_seconds")
                                               .Help("From a request's first byte to the last of its answer")
                                               .Register(registry);
  Counter& rays =
      prometheus::BuildCounter().Name("orrery_rays_total").Help("Rays traced").Register(registry).Add({});
  Counter& clients_left = prometheus::BuildCounter()
                              .Name("orrery_clients_left_total")
                              .Help("Requests whose client left before the end of the answer")
                              .Register(registry)
                              .Add({});
  Counter& refused = prometheus::BuildCounter()
                         .Name("orrery_connections_refused_total")
                         .Help("Connections turned away because there were too many")
                         .Register(registry)
                         .Add({});
  Gauge& ready = add_gauge("orrery_ready", "1 while new work is taken");
  Gauge& running = add_gauge("orrery_renders_running", "Renders that have their turn");
  Gauge& waiting = add_gauge("orrery_renders_waiting", "Renders that wait for their turn");
  Gauge& orbits = add_gauge("orrery_orbits", "Different orbits that are streamed");
  Gauge& jobs = add_gauge("orrery_jobs", "Jobs under way");
  Gauge& connections = add_gauge("orrery_connections", "Connections that are open");
  prometheus::Family<Gauge>& stored = prometheus::BuildGauge()
                                          .Name("orrery_stored_bytes")
                                          .Help("Bytes kept, of scenes by estimate")
                                          .Register(registry);
  Gauge& scenes = stored.Add({{"store", "scenes"}});
  Gauge& assets = stored.Add({{"store", "assets"}});
  Gauge& pictures = stored.Add({{"store", "pictures"}});
  Gauge& job_pictures = stored.Add({{"store", "jobs"}});
  Gauge& resident = add_gauge("process_resident_memory_bytes", "Memory in use");
  Gauge& files = add_gauge("process_open_fds", "Open file descriptors");

  Families() {
    prometheus::BuildGauge()
        .Name("orrery_build_info")
        .Help("1, with the version as a label")
        .Register(registry)
        .Add({{"version", std::string(kVersion)}})
        .Set(1);
  }

 private:
  Gauge& add_gauge(const char* name, const char* help) {
    return prometheus::BuildGauge().Name(name).Help(help).Register(registry).Add({});
  }
};

Metrics::Metrics() : families_(std::make_unique<Families>()) {}
Metrics::~Metrics() = default;

void Metrics::count_request(std::string_view route, std::string_view method, int status, double seconds,
                            bool client_left) {
  constexpr std::array<std::string_view, 6> kMethods{"GET", "HEAD", "POST", "PUT", "DELETE", "OPTIONS"};
  const bool known = std::find(kMethods.begin(), kMethods.end(), method) != kMethods.end();
  const std::string name(route.empty() ? "none" : route), verb(known ? method : "other");
  families_->requests.Add({{"route", name}, {"method", verb}, {"code", std::to_string(status)}}).Increment();
  families_->seconds.Add({{"route", name}}, kSeconds).Observe(seconds);
  if (client_left) families_->clients_left.Increment();
}

std::string Metrics::text(const Readings& readings) const {
  const std::lock_guard lock(reading_);
  Families& f = *families_;
  const auto set = [](Gauge& gauge, auto value) { gauge.Set(static_cast<double>(value)); };
  set(f.ready, readings.ready);
  set(f.running, readings.renders_running);
  set(f.waiting, readings.renders_waiting);
  set(f.orbits, readings.orbits);
  set(f.jobs, readings.jobs);
  set(f.connections, readings.connections);
  set(f.scenes, readings.scene_bytes);
  set(f.assets, readings.asset_bytes);
  set(f.pictures, readings.picture_bytes);
  set(f.job_pictures, readings.job_bytes);
  set(f.resident, resident_bytes());
  set(f.files, open_files());
  const auto count = [](prometheus::Counter& counter, std::uint64_t value) {
    counter.Increment(static_cast<double>(value) - counter.Value());
  };
  count(f.refused, readings.connections_refused);
  count(f.rays, readings.rays);
  return prometheus::TextSerializer().Serialize(f.registry.Collect());
}

}  // namespace orrery
