#include "server/service/metrics_snapshot.h"

#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>

#include "core/base/clock.h"
#include "core/base/version.h"

namespace orrery {
namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;
using Labels = std::vector<ClientMetric::Label>;

template <class Number>
ClientMetric value(const Number& number, Labels labels = {}) {
  ClientMetric metric;
  metric.label = std::move(labels);
  metric.gauge.value = metric.counter.value = static_cast<double>(number);  // the family's type selects one
  return metric;
}

ClientMetric histogram(const SecondsHistogram& seconds, Labels labels = {}) {
  ClientMetric metric = seconds.Collect();
  metric.label = std::move(labels);
  return metric;
}

// Returns read(store) of each store, with the store's name as a label.
template <class Read>
std::vector<ClientMetric> per_store(App& app, const Read& read) {
  return {value(read(app.scenes()), {{"store", "scenes"}}), value(read(app.assets()), {{"store", "assets"}}),
          value(read(app.renders().pictures()), {{"store", "pictures"}}),
          value(read(app.renders().films()), {{"store", "films"}}),
          value(read(app.jobs()), {{"store", "jobs"}})};
}

double resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  double size = 0, resident = 0;
  statm >> size >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

std::ptrdiff_t open_files() {
  std::error_code gone;
  const std::filesystem::directory_iterator files("/proc/self/fd", gone);
  return std::distance(begin(files), end(files));
}

// Appends the process metrics under the standard names of Prometheus client libraries.
void append_process_metrics(std::vector<MetricFamily>& families, const ServiceCounters& meters) {
  constexpr MetricType kCounter = MetricType::Counter, kGauge = MetricType::Gauge;
  const double started = std::chrono::duration<double>(meters.started.time_since_epoch()).count();
  families.insert(families.end(),
                  {{"process_cpu_seconds_total", "CPU time used", kCounter, {value(process_cpu_ms() / 1000)}},
                   {"process_start_time_seconds",
                    "Start of the service, in seconds since 1970",
                    kGauge,
                    {value(started)}},
                   {"process_resident_memory_bytes", "Resident memory", kGauge, {value(resident_bytes())}},
                   {"process_open_fds", "Open file descriptors", kGauge, {value(open_files())}}});
}

MetricFamily cancelled_family(const ServiceCounters& meters) {
  MetricFamily family{"orrery_cancelled_total",
                      "Work cancelled after a disconnect, a timeout or the end of the service, by stage",
                      MetricType::Counter,
                      {}};
  for (std::size_t i = 0; i < kStages.size(); ++i)
    family.metric.push_back(value(meters.cancelled[i], {{"stage", std::string(kStages[i])}}));
  return family;
}

MetricFamily limits_family(const Settings& settings) {
  MetricFamily family{"orrery_limit", "Limits of /v1/limits", MetricType::Gauge, {}};
  for (const Setting& limit : limits())
    family.metric.push_back(value(std::stod(limit.text(settings)), {{"limit", std::string(limit.name)}}));
  family.metric.push_back(value(work_bytes(settings), {{"limit", "work_bytes"}}));
  return family;
}

}  // namespace

std::vector<MetricFamily> collect_metrics(App& app, const HttpServer& server, const Log& log) {
  constexpr MetricType kCounter = MetricType::Counter, kGauge = MetricType::Gauge;
  const Admission& admission = app.admission();
  const ServiceCounters& meters = app.meters();
  SceneStore& scenes = app.scenes();
  std::vector<MetricFamily> families{
      {"orrery_build_info",
       "1, with the version as a label",
       kGauge,
       {value(1, {{"version", std::string(kVersion)}})}},
      {"orrery_ready", "1 while new work is accepted", kGauge, {value(app.readiness() == "ok")}},
      {"orrery_renders_running", "Renders that hold a slot", kGauge, {value(admission.running())}},
      {"orrery_renders_waiting", "Renders in the queue", kGauge, {value(admission.waiting())}},
      {"orrery_preemptions_total",
       "Preemptions: running work that yielded its slot to other work",
       kCounter,
       {value(admission.preemptions())}},
      {"orrery_queue_wait_seconds",
       "Queue time of requests",
       MetricType::Histogram,
       {histogram(admission.waits(Priority::interactive), {{"lane", "interactive"}}),
        histogram(admission.waits(Priority::batch), {{"lane", "batch"}})}},
      {"orrery_render_seconds",
       "Time to build the structure and trace a frame",
       MetricType::Histogram,
       {histogram(meters.render)}},
      {"orrery_rays_total", "Rays traced", kCounter, {value(meters.rays)}},
      {"orrery_cache_hits_total",
       "Images, films and scenes found in a cache",
       kCounter,
       {value(meters.pictures_found, {{"cache", "pictures"}}),
        value(meters.films_found, {{"cache", "films"}}), value(scenes.hits(), {{"cache", "scenes"}})}},
      {"orrery_cache_misses_total",
       "Images encoded, films rendered and scenes loaded",
       kCounter,
       {value(meters.pictures_made, {{"cache", "pictures"}}), value(meters.films_made, {{"cache", "films"}}),
        value(scenes.loads(), {{"cache", "scenes"}})}},
      {"orrery_work_bytes",
       "Bytes of scenes that are not cached and of images in progress",
       kGauge,
       {value(app.memory().bytes())}},
      {"orrery_stored_bytes", "Bytes stored", kGauge,
       per_store(app, [](auto& store) { return store.bytes(); })},
      {"orrery_evictions_total", "Entries evicted from a full store", kCounter,
       per_store(app, [](auto& store) { return store.evictions(); })},
      {"orrery_reload_failures_total",
       "Failed reloads of tokens, keys and settings (SIGHUP)",
       kCounter,
       {value(meters.reloads_failed)}},
      {"orrery_orbits", "Distinct orbits being streamed", kGauge, {value(app.orbits().count())}},
      {"orrery_jobs", "Unfinished jobs", kGauge, {value(app.jobs().under_way())}},
      {"orrery_jobs_ended_total",
       "Ended jobs by outcome",
       kCounter,
       {value(meters.jobs_done, {{"outcome", "done"}}), value(meters.jobs_failed, {{"outcome", "failed"}}),
        value(meters.jobs_cancelled, {{"outcome", "cancelled"}})}},
      {"orrery_log_lines_dropped_total",
       "Log lines dropped because the log's reader was too slow or had exited",
       kCounter,
       {value(log.dropped())}},
      {"orrery_connections", "Open connections", kGauge, {value(server.connections())}},
      {"orrery_connections_refused_total",
       "Connections rejected because there were too many",
       kCounter,
       {value(server.refused())}},
  };
  families.push_back(cancelled_family(meters));
  families.push_back(limits_family(app.settings()));
  append_process_metrics(families, meters);
  return families;
}

}  // namespace orrery
