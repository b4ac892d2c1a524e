#include <algorithm>
#include <atomic>
#include <sstream>
#include <thread>

#include "tests/http/daemon.h"
#include "tests/support/eventually.h"

// Tests jobs, which run without a connected client.
namespace orrery {
namespace {

using nlohmann::json;

constexpr const char* kJson = "application/json";

struct Event {
  std::string name;
  int id = -1;
  json data;
};

std::vector<Event> parse_events(const std::string& text) {
  std::vector<Event> events;
  std::istringstream lines(text);
  Event event;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("event: ", 0) == 0) event.name = line.substr(7);
    if (line.rfind("id: ", 0) == 0) event.id = std::stoi(line.substr(4));
    if (line.rfind("data: ", 0) == 0) event.data = json::parse(line.substr(6));
    if (line.empty()) events.push_back(std::exchange(event, {}));
  }
  return events;
}

// Client that receives the events of a job.
class Watcher {
 public:
  // Connects, and returns once the first bytes have arrived.
  Watcher(const Daemon& daemon, const json& job)
      : thread_([this, &daemon, path = job_path(job) + "/events"] {
          daemon.client().Get(path, [this](const char* bytes, std::size_t count) {
            text_.append(bytes, count);
            begun_ = true;
            return true;
          });
        }) {
    EXPECT_TRUE(test::eventually([this] { return begun_.load(); }));
  }
  // Waits for the end of the stream and returns its events.
  std::vector<Event> told() {
    thread_.join();
    return parse_events(text_);
  }

 private:
  std::string text_;
  std::atomic<bool> begun_{false};
  std::thread thread_;  // last member, since it uses the others
};

class JobTest : public HttpTest {
 protected:
  json start(const json& body, const httplib::Headers& headers = {}) {
    const auto result = client_.Post("/v1/jobs", headers, body.dump(), kJson);
    EXPECT_TRUE(result);
    EXPECT_EQ(result->status, 202) << result->body;
    const json job = json::parse(result->body);
    EXPECT_EQ(result->get_header_value("Location"), job_path(job));
    return job;
  }
  std::vector<Event> events(const json& job, const httplib::Headers& headers = {}) {
    const auto result = client_.Get(job_path(job) + "/events", headers);
    EXPECT_EQ(result->get_header_value("Content-Type"), "text/event-stream");
    return parse_events(result->body);
  }
  json status(const json& job) { return json::parse(client_.Get(job_path(job))->body); }
};

const json kOrbit = {{"frames", 4}, {"step_degrees", 30}};
json endless() {
  return {{"scene", small_scene()},
          {"image", {{"width", 4096}, {"height", 4096}}},
          {"render", {{"samples", 4096}, {"precision", "double"}}}};
}

// Streams may use six of the eight connections, and one client may use three of these.
TEST(Streams, LimitsStreamsPerClient) {
  Daemon daemon({"--connections", "8"});
  httplib::Client client = daemon.client();
  const auto started = client.Post("/v1/jobs", endless().dump(), kJson);
  const std::string events = json::parse(started->body).at("events");
  const auto watch = [&](const RawClient& watcher) {
    watcher.send("GET " + events + " HTTP/1.1\r\nHost: x\r\n\r\n");
    return watcher.receive_some().substr(9, 3);
  };
  RawClient first(daemon.port()), second(daemon.port()), third(daemon.port());
  for (const RawClient* watcher : {&first, &second, &third}) EXPECT_EQ(watch(*watcher), "200");

  const auto refused = client.Get(events);
  EXPECT_EQ(refused->status, 429) << refused->body;
  const int retry_s = std::stoi(refused->get_header_value("Retry-After"));
  EXPECT_TRUE(retry_s == 5 || retry_s == 6) << retry_s;  // with jitter
  EXPECT_EQ(json::parse(refused->body).at("detail"),
            "3 streams of this client are open (limit 3 per client, connections)");
  third.close();
  // A stream has ended.
  EXPECT_TRUE(test::eventually([&] { return watch(RawClient(daemon.port())) == "200"; }));
}

TEST_F(JobTest, RendersOrbitAndReportsEveryFrame) {
  const json job = start({{"scene", small_scene()}, {"orbit", kOrbit}});
  EXPECT_EQ(job.at("frames"), 4);
  const auto told = events(job);
  std::vector<int> frames;
  for (const Event& event : told)
    if (event.name == "frame") frames.push_back(event.data.at("frame"));
  EXPECT_EQ(frames, (std::vector<int>{0, 1, 2, 3}));
  ASSERT_FALSE(told.empty());
  EXPECT_EQ(told.back().name, "done");
  EXPECT_EQ(told.back().data.at("tiles_done"), told.back().data.at("tiles"));
  EXPECT_GT(told.back().data.at("tiles"), 0);
  const std::string scene = "/v1/scenes/" + post_scene(small_scene().dump()) + "/frame.png";
  for (int i = 0; i < 4; ++i) {
    const auto frame = client_.Get(job_path(job) + "/frames/" + std::to_string(i) + ".png");
    EXPECT_EQ(frame->get_header_value("Content-Type"), "image/png");
    EXPECT_EQ(frame->body, client_.Get(scene + "?azimuth=" + std::to_string(30 * i))->body) << i;
    EXPECT_EQ(
        get_known(job_path(job) + "/frames/" + std::to_string(i) + ".png", frame->get_header_value("ETag"))
            ->status,
        304);
  }
  expect_problem(client_.Get(job_path(job) + "/frames/4.png"), 404);
  expect_problem(client_.Get(job_path(job) + "/frames/00.png"), 404);
  expect_problem(client_.Get(job_path(job) + "/frames/0.jpg"), 404);
}

// The first frame determines the plan for all frames.
TEST_F(JobTest, AppliesBudgetToOrbit) {
  const json job = start({{"scene", small_scene()}, {"orbit", kOrbit}, {"budget", {{"max_error", 0.2}}}});
  const auto told = events(job);
  ASSERT_EQ(told.back().name, "done");
  const json budget = told.back().data.at("budget");
  EXPECT_EQ(budget.at("met"), true);
  EXPECT_EQ(budget.at("frames_met"), 4);
  EXPECT_LE(budget.at("largest_bound"), 0.2);
  EXPECT_EQ(told.back().data.at("tiles_done"), told.back().data.at("tiles"));
  double largest = 0;
  for (const Event& event : told)
    if (event.name == "frame") {
      EXPECT_EQ(event.data.at("bound").at("space"), "display");
      largest = std::max(largest, event.data.at("bound").at("rms").get<double>());
    }
  EXPECT_EQ(budget.at("largest_bound"), largest);
  const std::string plan = budget.at("plan");
  EXPECT_EQ(plan.find("error"), std::string::npos) << plan;
  const std::string scene = "/v1/scenes/" + post_scene(small_scene().dump()) + "/frame.png?" + plan;
  for (int i = 0; i < 4; ++i) {
    const auto frame = client_.Get(job_path(job) + "/frames/" + std::to_string(i) + ".png");
    EXPECT_EQ(frame->body, client_.Get(scene + "&azimuth=" + std::to_string(30 * i))->body) << i;
  }
}

TEST_F(JobTest, FailsOnMissedBudgetIfRequested) {
  const json budget = {{"max_error", 1e-5}, {"on_budget_miss", "fail"}};
  const auto told = events(start({{"scene", small_scene()}, {"orbit", kOrbit}, {"budget", budget}}));
  ASSERT_EQ(told.back().name, "failed");
  const json error = told.back().data.at("error");
  EXPECT_EQ(error.at("type"), "urn:orrery:problem:missed-budget");
  EXPECT_EQ(told.back().data.at("frames_done"), 0);
}

TEST_F(JobTest, ResumesAfterLastEventId) {
  const json job = start({{"scene", small_scene()}, {"orbit", kOrbit}});
  const auto all = events(job);
  const auto rest = events(job, {{"Last-Event-ID", "2"}});
  ASSERT_EQ(rest.size(), 3U);  // two frames and the event `done`
  EXPECT_EQ(rest[0].data.at("frame"), 2);
  EXPECT_EQ(rest[2].name, "done");
  EXPECT_EQ(events(job, {{"Last-Event-ID", "4"}}).size(), 1U);
  EXPECT_EQ(client_
                .Get(job_path(job) + "/events",
                     {{"Last-Event-ID", std::to_string(all.back().id)}, {"Connection", "close"}})
                ->status,
            204);
  for (const char* wrong : {"x", "-1", "1x", "99999999999"})
    expect_problem(client_.Get(job_path(job) + "/events", {{"Last-Event-ID", wrong}}), 400);
}

TEST_F(JobTest, FinishesWithoutClientAndDeletesOnce) {
  const json job = start({{"scene", small_scene()}});
  EXPECT_TRUE(test::eventually([&] { return status(job).at("state") == "done"; }));
  EXPECT_TRUE(is_png(client_.Get(job_path(job) + "/frames/0.png")->body));
  EXPECT_EQ(client_.Delete(job_path(job))->status, 204);
  expect_problem(client_.Get(job_path(job)), 404);
  expect_problem(client_.Get(job_path(job) + "/frames/0.png"), 404);
  expect_problem(client_.Delete(job_path(job)), 404);
}

TEST_F(JobTest, ReturnsConflictForUnfinishedFrame) {
  const json job = start(endless());
  const json problem = expect_problem(client_.Get(job_path(job) + "/frames/0.png"), 409);
  EXPECT_NE(problem.at("detail").get<std::string>().find("0 of 1"), std::string::npos);
  client_.Delete(job_path(job));
}

TEST_F(JobTest, CancelsOnDeleteAndNotifiesWatchers) {
  EXPECT_TRUE(daemon().wait_until_idle());
  const json job = start(endless());
  EXPECT_TRUE(daemon().wait_until_working());
  Watcher watcher(daemon(), job);
  EXPECT_EQ(client_.Delete(job_path(job))->status, 204);
  const auto told = watcher.told();
  ASSERT_FALSE(told.empty());
  EXPECT_EQ(told.back().name, "cancelled");
  EXPECT_EQ(told.front().name, "progress");
  EXPECT_TRUE(daemon().wait_until_idle());
}

TEST_F(JobTest, StartsOneJobPerIdempotencyKey) {
  const httplib::Headers key{{"Idempotency-Key", "\"a-1\""}};
  const json body = {{"scene", small_scene()}, {"orbit", kOrbit}};
  const json job = start(body, key);
  EXPECT_EQ(start(body, key).at("id"), job.at("id"));
  EXPECT_NE(start(body).at("id"), job.at("id"));
  json other = body;
  other["orbit"]["frames"] = 5;
  expect_problem(client_.Post("/v1/jobs", key, other.dump(), kJson), 422);
  expect_problem(client_.Post("/v1/jobs", {{"Idempotency-Key", std::string(256, 'x')}}, body.dump(), kJson),
                 400);
}

TEST_F(JobTest, ReportsPointersOfInvalidInput) {
  const auto pointer = [&](const json& body) {
    const json problem = expect_problem(client_.Post("/v1/jobs", body.dump(), kJson), 422);
    return problem.at("errors").at(0).at("pointer").get<std::string>();
  };
  EXPECT_EQ(pointer({{"scene", small_scene()}, {"orbit", {{"frames", 0}}}}), "/orbit/frames");
  EXPECT_EQ(pointer({{"scene", small_scene()}, {"orbit", {{"frames", 1e6}}}}), "/orbit/frames");
  EXPECT_EQ(pointer({{"scene", small_scene()}, {"orbit", {{"step_degrees", 361}}}}), "/orbit/step_degrees");
  EXPECT_EQ(pointer({{"scene", small_scene()}, {"orbit", {{"step", 3}}}}), "/orbit");
  EXPECT_EQ(pointer({{"scene", small_scene()}, {"image", {{"width", 0}}}}), "/image/width");
  EXPECT_EQ(pointer({{"scene", small_scene()}, {"lane", "batch"}}), "");
  expect_problem(client_.Post("/v1/jobs", json{{"scene_id", "nothing"}}.dump(), kJson), 404);
  expect_problem(client_.Post("/v1/jobs", "{", kJson), 400);
  expect_problem(client_.Get("/v1/jobs/nothing/events"), 404);
  const json turned = {{"scene", small_scene()}, {"orbit", kOrbit}};
  EXPECT_EQ(
      expect_problem(client_.Post("/v1/render", turned.dump(), kJson), 422).at("errors")[0].at("pointer"),
      "");
}

json post_job(Daemon& daemon, const json& body, int status = 202) {
  const auto result = daemon.client().Post("/v1/jobs", body.dump(), kJson);
  EXPECT_EQ(result->status, status) << result->body;
  return json::parse(result->body);
}

// Waits for the end of the job and returns its events.
std::vector<Event> events_of(Daemon& daemon, const json& job) {
  return parse_events(daemon.client().Get(job_path(job) + "/events")->body);
}

TEST(JobLimits, EnforcesAndReportsLimits) {
  Daemon daemon({"--jobs", "4", "--job-bytes", "3000"});
  const json first = post_job(daemon, endless());
  post_job(daemon, endless());
  const json problem = post_job(daemon, endless(), 429);
  EXPECT_NE(problem.at("detail").get<std::string>().find("per client, jobs)"), std::string::npos);
  daemon.client().Delete(job_path(first));
  const auto told =
      events_of(daemon, post_job(daemon, {{"scene", small_scene()}, {"orbit", {{"frames", 100}}}}));
  EXPECT_EQ(told.back().name, "failed");
  EXPECT_NE(told.back().data.at("error").at("detail").get<std::string>().find("job_bytes)"),
            std::string::npos);
}

TEST(JobLimits, LimitsJobsOfAllClients) {
  Daemon daemon({"--jobs", "1"});
  const json first = post_job(daemon, endless());
  EXPECT_NE(post_job(daemon, endless(), 503).at("detail").get<std::string>().find("(limit 1, jobs)"),
            std::string::npos);
}

TEST(JobLimits, LimitsNumberOfEndedJobs) {
  Daemon daemon({"--max-finished-jobs", "3"});
  std::vector<std::string> paths;
  for (int i = 0; i < 20; ++i) {
    const json job = post_job(daemon, {{"scene", small_scene()}, {"camera", {{"azimuth_degrees", i}}}});
    paths.push_back(job_path(job));
    EXPECT_EQ(events_of(daemon, job).back().name, "done");
  }
  int there = 0;
  for (const std::string& kept : paths) there += daemon.client().Get(kept)->status == 200;
  EXPECT_EQ(there, 3);
  EXPECT_EQ(daemon.client().Get(paths.back())->status, 200);
}

TEST(JobLimits, KeepsJobsOfOtherClientsDuringFlood) {
  Daemon daemon({"--max-finished-jobs", "5"});
  const json job = post_job(daemon, {{"scene", small_scene()}});
  EXPECT_EQ(events_of(daemon, job).back().name, "done");
  httplib::Client flood = daemon.client_at(2);
  for (int i = 0; i < 20; ++i) {
    const json tiny = {{"scene", small_scene({{"title", std::to_string(i)}})},
                       {"image", {{"width", 1}, {"height", 1}}}};
    const auto started = flood.Post("/v1/jobs", tiny.dump(), kJson);
    ASSERT_EQ(started->status, 202) << started->body;
    EXPECT_EQ(events_of(daemon, json::parse(started->body)).back().name, "done");
  }
  EXPECT_EQ(daemon.client().Get(job_path(job) + "/frames/0.png")->status, 200);
  expect_problem(flood.Delete(job_path(job)), 403);
  EXPECT_GT(daemon.metric("orrery_evictions_total{store=\"jobs\"}"), 10);
}

TEST(JobLimits, AdmitsRendersWhileJobsWait) {
  Daemon daemon;
  for (int i = 0; i < 4; ++i) post_job(daemon, endless());
  EXPECT_TRUE(daemon.wait_until_working());
  const auto result = daemon.client().Post("/v1/render", small_scene().dump(), kJson);
  EXPECT_EQ(result->status, 200) << result->body;
  EXPECT_EQ(json::parse(daemon.client().Get("/readyz")->body).at("status"), "ok");
}

TEST(JobLimits, EvictsOldestResults) {
  Daemon daemon({"--job-bytes", "3000"});
  std::vector<std::string> paths;
  for (int i = 0; i < 8; ++i) {
    const json job = post_job(daemon, {{"scene", small_scene()}, {"camera", {{"azimuth_degrees", i}}}});
    paths.push_back(job_path(job));
    EXPECT_EQ(events_of(daemon, job).back().name, "done");
  }
  EXPECT_EQ(daemon.client().Get(paths.front())->status, 404);
  EXPECT_EQ(daemon.client().Get(paths.back())->status, 200);
}

TEST(JobLimits, FailsJobOnShutdown) {
  Daemon daemon;
  const json job = post_job(daemon, endless());
  EXPECT_TRUE(daemon.wait_until_working());
  Watcher watcher(daemon, job);
  daemon.signal(SIGTERM);
  const auto told = watcher.told();
  EXPECT_EQ(daemon.wait(), 0);
  ASSERT_FALSE(told.empty());
  EXPECT_EQ(told.back().name, "failed");
  EXPECT_EQ(told.back().data.at("error").at("status"), 503);
}

}  // namespace
}  // namespace orrery
