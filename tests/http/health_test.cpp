#include <algorithm>
#include <chrono>
#include <sstream>
#include <thread>

#include "tests/http/daemon.h"

// Tests health checks and metrics under load.
namespace orrery {
namespace {

std::string metrics(Daemon& daemon) {
  const auto result = daemon.health_client().Get("/metrics");
  return result && result->status == 200 ? result->body : "";
}

// Returns the value of a series in the metrics, or -1 if it is missing.
double value_of(const std::string& text, const std::string& series) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.rfind(series + " ", 0) == 0) return std::stod(line.substr(series.size() + 1));
  return -1;
}

// Returns true if `holds` becomes true for the metrics within 20 s.
template <class Holds>
bool metrics_reach(Daemon& daemon, const Holds& holds) {
  for (int i = 0; i < 400; ++i) {
    if (holds(metrics(daemon))) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

TEST(Health, ListensOnSeparatePort) {
  Daemon daemon;
  auto client = daemon.health_client();
  EXPECT_EQ(client.Get("/healthz")->status, 200);
  EXPECT_EQ(client.Get("/readyz")->status, 200);
  const auto text = client.Get("/metrics");
  EXPECT_EQ(text->get_header_value("Content-Type"), "text/plain; version=0.0.4; charset=utf-8");
  EXPECT_EQ(text->get_header_value("Cache-Control"), "no-store");
  for (const char* path : {"/", "/v1/catalog", "/v1/scenes"}) expect_problem(client.Get(path), 404);
  expect_problem(client.Post("/healthz", "x", "text/plain"), 405);
  expect_problem(daemon.client().Get("/metrics"), 404);  // only on the health port
}

TEST(Health, RespondsWhileAllConnectionsAreUsed) {
  Daemon daemon(without_ray_limit({"--threads", "1", "--max-queued-rays", "1", "--interactive-rays",
                                   "1000000000000", "--connections", "3"}));
  const auto posted = daemon.client().Post("/v1/scenes", small_scene().dump(), "application/json");
  const std::string path = "/v1/scenes/" + nlohmann::json::parse(posted->body).at("id").get<std::string>() +
                           "/frame.png?width=4096&height=4096&samples=4096&precision=double";
  EXPECT_TRUE(
      metrics_reach(daemon, [](const auto& text) { return value_of(text, "orrery_connections") == 0; }));
  std::vector<std::unique_ptr<RawClient>> clients;
  for (int i = 0; i < 3; ++i) {  // two requests render, one waits, and all connections are in use
    clients.push_back(std::make_unique<RawClient>(daemon.port()));
    clients.back()->send("GET " + path + "&seed=" + std::to_string(i) + " HTTP/1.1\r\nHost: x\r\n\r\n");
    EXPECT_TRUE(metrics_reach(daemon, [i](const auto& text) {
      return value_of(text, "orrery_renders_running") + value_of(text, "orrery_renders_waiting") == i + 1;
    }));
  }
  auto client = daemon.health_client();
  EXPECT_EQ(client.Get("/readyz")->status, 200);  // one client has all slots, but would yield one to another
  EXPECT_EQ(client.Get("/healthz")->status, 200);
  RawClient refused(daemon.port());
  EXPECT_NE(refused.receive_all().find(" 503 "), std::string::npos);
  const std::string text = metrics(daemon);
  EXPECT_EQ(value_of(text, "orrery_ready"), 1);
  EXPECT_EQ(value_of(text, "orrery_renders_running"), 2);
  // A preempted render continues until its next checkpoint.
  EXPECT_TRUE(
      metrics_reach(daemon, [](const auto& now) { return value_of(now, "orrery_renders_waiting") == 1; }));
  EXPECT_EQ(value_of(text, "orrery_connections"), 3);
  EXPECT_EQ(value_of(text, "orrery_connections_refused_total"), 1);
}

TEST(Health, CountsResponsesInMetrics) {
  const auto now_s = [] {
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  };
  const double before = now_s();
  Daemon daemon;
  const double after = now_s();
  auto client = daemon.client();
  const auto posted = client.Post("/v1/scenes", small_scene().dump(), "application/json");
  const std::string scene = "/v1/scenes/" + nlohmann::json::parse(posted->body).at("id").get<std::string>();
  for (int i = 0; i < 3; ++i) client.Get(scene + "/frame.png");
  client.Get(scene + "/frame.png?width=0");
  client.Get("/nothing/here");
  const std::string none = "orrery_requests_total{code=\"404\",method=\"GET\",route=\"none\"}";
  EXPECT_TRUE(metrics_reach(daemon, [&](const std::string& now) { return value_of(now, none) == 1; }));
  const std::string text = metrics(daemon);  // a response is counted once it is sent
  const std::string frame = ",method=\"GET\",route=\"/v1/scenes/{id}/frame.png\"}";
  EXPECT_EQ(value_of(text, "orrery_requests_total{code=\"200\"" + frame), 3);
  EXPECT_EQ(value_of(text, "orrery_requests_total{code=\"422\"" + frame), 1);
  EXPECT_EQ(value_of(text, "orrery_request_seconds_count{route=\"/v1/scenes/{id}/frame.png\"}"), 4);
  EXPECT_GE(value_of(text, "orrery_rays_total"), 48 * 32);  // rendered once
  for (const char* store : {"scenes", "pictures"})
    EXPECT_GT(value_of(text, "orrery_stored_bytes{store=\"" + std::string(store) + "\"}"), 0);
  EXPECT_EQ(value_of(text, "orrery_jobs"), 0);
  EXPECT_EQ(value_of(text, "orrery_preemptions_total"), 0);
  EXPECT_GT(value_of(text, "orrery_sent_bytes_total"), 3000);
  EXPECT_EQ(value_of(text, "orrery_limit{limit=\"response_buffer_bytes\"}"), 256 << 20);
  EXPECT_GT(value_of(text, "process_resident_memory_bytes"), 1e6);
  EXPECT_GT(value_of(text, "process_open_fds"), 3);
  EXPECT_GE(value_of(text, "process_start_time_seconds"), before);
  EXPECT_LE(value_of(text, "process_start_time_seconds"), after);
  const double used = value_of(text, "process_cpu_seconds_total");
  EXPECT_GT(used, 0);
  EXPECT_GT(value_of(metrics(daemon), "process_cpu_seconds_total"), used)
      << "the requests used processor time";
}

TEST(Health, CountsCacheHitsAndMisses) {
  Daemon daemon;
  auto client = daemon.client();
  const std::string text = small_scene().dump();
  const auto scene =
      "/v1/scenes/" + nlohmann::json::parse(client.Post("/v1/scenes", text, "application/json")->body)
                          .at("id")
                          .get<std::string>();
  client.Post("/v1/scenes", small_scene().dump(4), "application/json");
  for (int i = 0; i < 3; ++i) client.Get(scene + "/frame.png");
  client.Post("/v1/render", text, "application/json");
  const nlohmann::json other = {{"scene", small_scene({{"title", "other"}})}};
  for (int i = 0; i < 2; ++i) client.Post("/v1/render", other.dump(), "application/json");
  const std::string told = metrics(daemon);
  EXPECT_EQ(value_of(told, "orrery_cache_misses_total{cache=\"scenes\"}"), 2);  // loaded
  EXPECT_EQ(value_of(told, "orrery_cache_hits_total{cache=\"scenes\"}"), 3);
  EXPECT_EQ(value_of(told, "orrery_cache_misses_total{cache=\"pictures\"}"), 2);  // encoded
  EXPECT_EQ(value_of(told, "orrery_cache_hits_total{cache=\"pictures\"}"), 4);
  EXPECT_EQ(value_of(told, "orrery_cache_misses_total{cache=\"films\"}"), 2);
  EXPECT_EQ(value_of(told, "orrery_cache_hits_total{cache=\"films\"}"), 0);
  EXPECT_EQ(value_of(told, "orrery_render_seconds_count"), 2);
  EXPECT_GT(value_of(told, "orrery_render_seconds_sum"), 0);
  EXPECT_EQ(value_of(told, "orrery_queue_wait_seconds_count{lane=\"interactive\"}"), 2);
  EXPECT_EQ(value_of(told, "orrery_queue_wait_seconds_count{lane=\"batch\"}"), 0);
}

TEST(Health, CountsRejectionsByReason) {
  Daemon daemon({"--max-request-body-bytes", "10000", "--jobs", "1"});
  auto client = daemon.client();
  client.Post("/v1/scenes", std::string(10'001, ' '), "application/json");
  const auto endless =
      small_scene({{"render", {{"samples", 4096}}}, {"image", {{"width", 4096}, {"height", 4096}}}});
  const auto job = client.Post("/v1/jobs", endless.dump(), "application/json");
  ASSERT_EQ(job->status, 202) << job->body;
  expect_problem(client.Post("/v1/jobs", endless.dump(), "application/json"), 503);
  EXPECT_TRUE(metrics_reach(daemon, [](const auto& text) {
    return value_of(text, "orrery_rejected_requests_total{reason=\"max_request_body_bytes\"}") == 1 &&
           value_of(text, "orrery_rejected_requests_total{reason=\"jobs\"}") == 1;
  })) << metrics(daemon);
}

TEST(Health, CountsEndedJobsByOutcome) {
  Daemon daemon({"--job-bytes", "20000"});
  auto client = daemon.client();
  const auto start = [&](int width, int samples) {
    const auto scene =
        small_scene({{"render", {{"samples", samples}}}, {"image", {{"width", width}, {"height", width}}}});
    const auto job = client.Post("/v1/jobs", scene.dump(), "application/json");
    return job_path(nlohmann::json::parse(job->body));
  };
  start(32, 1);
  start(1000, 1);  // its result exceeds job_bytes
  const std::string endless = start(4096, 4096);
  EXPECT_EQ(client.Delete(endless)->status, 204);
  for (const char* outcome : {"done", "failed", "cancelled"})
    EXPECT_TRUE(metrics_reach(daemon,
                              [&](const auto& text) {
                                return value_of(text, "orrery_jobs_ended_total{outcome=\"" +
                                                          std::string(outcome) + "\"}") == 1;
                              }))
        << outcome << metrics(daemon);
  EXPECT_GT(value_of(metrics(daemon), "orrery_queue_wait_seconds_count{lane=\"batch\"}"), 1);
}

// Labels are route patterns, so that arbitrary paths cannot exhaust memory.
TEST(Health, GroupsUnknownRequestsInOneSeries) {
  Daemon daemon;
  const auto lines = [&] {
    const std::string text = metrics(daemon);
    return std::count(text.begin(), text.end(), '\n');
  };
  const auto ask = [&](const std::string& method, const std::string& path) {
    RawClient raw(daemon.port());
    raw.send(method + " " + path + " HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
    raw.receive_all();
  };
  ask("BREW", "/coffee");
  const auto is_counted = [&](const std::string& route) {  // counted shortly after the response
    const std::string series = "orrery_request_seconds_count{route=\"" + route + "\"}";
    return metrics_reach(daemon, [&](const auto& text) { return value_of(text, series) > 0; });
  };
  ASSERT_TRUE(is_counted("none") && is_counted("/metrics"));
  const auto before = lines();
  for (int i = 0; i < 50; ++i) ask("BREW" + std::to_string(i), "/coffee/" + std::to_string(i));
  EXPECT_EQ(lines(), before);
}

}  // namespace
}  // namespace orrery
