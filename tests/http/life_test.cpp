#include <signal.h>

#include <future>

#include "tests/http/daemon.h"
#include "tests/support/eventually.h"
#include "tests/support/sanitized.h"

// Tests cancellation after disconnects, and shutdown of the daemon.
namespace orrery {
namespace {

constexpr const char* kEndless = "?width=4096&height=4096&samples=4096&precision=double";

std::string post(Daemon& daemon, const nlohmann::json& scene) {
  const auto result = daemon.client().Post("/v1/scenes", scene.dump(), "application/json");
  return "/v1/scenes/" + nlohmann::json::parse(result->body).at("id").get<std::string>();
}

std::string get(const std::string& path) { return "GET " + path + " HTTP/1.1\r\nHost: x\r\n\r\n"; }

TEST(Disconnect, CancelsRender) {
  Daemon daemon(without_ray_limit());
  const std::string scene = post(daemon, small_scene());
  RawClient raw(daemon.port());
  raw.send(get(scene + "/frame.png" + kEndless));
  ASSERT_TRUE(daemon.wait_until_working());
  raw.close();
  EXPECT_TRUE(daemon.wait_until_idle());
  EXPECT_EQ(daemon.client().Get(scene + "/frame.png")->status, 200);
  EXPECT_NE(daemon.health_client().Get("/metrics")->body.find("orrery_cancelled_total{stage=\"render\"} 1\n"),
            std::string::npos);
}

// A half-closed connection looks like a disconnect until the server probes it.
TEST(HalfClosedClient, ReceivesResponse) {
  Daemon daemon;
  const RawClient raw(daemon.port());
  const std::string size = test::kSanitized ? "?width=400&height=400" : "?width=800&height=800";
  const std::string frame = post(daemon, small_scene()) + "/frame.png" + size + "&samples=16";
  raw.send(get(frame) + get("/healthz"));
  raw.shutdown_send();
  const std::string answers = raw.receive_all();
  const std::size_t picture = answers.find("HTTP/1.1 200"), health = answers.rfind("HTTP/1.1 200");
  EXPECT_NE(picture, std::string::npos);
  EXPECT_NE(picture, health);
  EXPECT_TRUE(is_png(answers.substr(answers.find("\r\n\r\n", picture) + 4)));
  EXPECT_EQ(daemon.metric("orrery_clients_left_total"), 0);
}

TEST(HalfClosedClient, CountsAsDisconnectedOverHttp10) {  // no probe in HTTP/1.0
  Daemon daemon(without_ray_limit());
  const RawClient raw(daemon.port());
  raw.send("GET " + post(daemon, small_scene()) + "/frame.png" + kEndless + " HTTP/1.0\r\n\r\n");
  ASSERT_TRUE(daemon.wait_until_working());
  raw.shutdown_send();
  EXPECT_TRUE(daemon.wait_until_idle());
}

TEST(Disconnect, CancelsPostedRender) {
  Daemon daemon(without_ray_limit());
  const std::string body =
      small_scene({{"image", {{"width", 4096}, {"height", 4096}}}, {"render", {{"samples", 4096}}}}).dump();
  RawClient raw(daemon.port());
  raw.send("POST /v1/render HTTP/1.1\r\nHost: x\r\nContent-Length: " + std::to_string(body.size()) +
           "\r\n\r\n" + body);
  ASSERT_TRUE(daemon.wait_until_working());
  raw.close();
  EXPECT_TRUE(daemon.wait_until_idle());
}

TEST(Disconnect, CancelsOrbit) {
  Daemon daemon(without_ray_limit());
  RawClient raw(daemon.port());
  raw.send(get(post(daemon, small_scene()) + "/orbit?frames=3600&fps=0&width=4096&height=4096&samples=4096"));
  ASSERT_TRUE(daemon.wait_until_working());
  raw.close();
  EXPECT_TRUE(daemon.wait_until_idle());
}

TEST(Disconnect, CancelsRefinement) {
  Daemon daemon(without_ray_limit());
  RawClient raw(daemon.port());
  raw.send(get(post(daemon, small_scene()) + "/refinement?width=400&height=300&samples=4096"));
  // The client disconnects during the pass with 128 samples per pixel, or 8 with a sanitizer.
#ifdef ORRERY_SANITIZED
  constexpr int kPasses = 4;
#else
  constexpr int kPasses = 8;
#endif
  ASSERT_TRUE(test::eventually([&] {
    return daemon.metric("orrery_cache_misses_total{cache=\"pictures\"}") >= kPasses &&
           daemon.metric("orrery_renders_running") == 1;
  }));
  raw.close();
  EXPECT_TRUE(daemon.wait_until_idle());
  EXPECT_NE(daemon.health_client().Get("/metrics")->body.find("orrery_cancelled_total{stage=\"render\"} 1\n"),
            std::string::npos);
}

TEST(Backpressure, PausesRefinementWhileClientDoesNotRead) {
  Daemon daemon(without_ray_limit());
  const RawClient raw(daemon.port(), 4096);
  raw.send(get(post(daemon, small_scene()) + "/refinement?width=1024&height=1024&samples=4096"));
  EXPECT_TRUE(test::eventually([&] { return !raw.receive_some().empty(); }));
  EXPECT_TRUE(daemon.wait_until_idle());  // the remaining passes would take 10 s or more
  EXPECT_EQ(daemon.metric("orrery_renders_running"), 0);
}

// Slow and incomplete request bodies share one byte limit.
TEST(SlowUploads, SharesOneByteLimit) {
  Daemon daemon({"--max-request-body-bytes", "1000000", "--asset-bytes", "1000000", "--request-buffer-bytes",
                 "1500000"});
  const auto head = [](int bytes) {
    return "POST /v1/scenes HTTP/1.1\r\nHost: x\r\nContent-Length: " + std::to_string(bytes) + "\r\n\r\n{";
  };
  const auto dawdle = [&] {
    auto client = std::make_unique<RawClient>(daemon.port());
    client->send(head(1'000'000) + std::string(950'000, ' '));
    return client;
  };
  auto slow = dawdle();
  // Announces a body, but sends none of it, and uses no bytes of the limit.
  const RawClient tells(daemon.port());
  tells.send(head(1'000'000));
  const auto post_until = [&](int status) {
    for (int i = 0;; ++i) {
      auto result = daemon.client().Post("/v1/scenes", std::string(600'000, ' '), "application/json");
      if (i == 500 || (result && result->status == status)) return result;
      if (!slow) continue;
      slow.reset();  // the last body to be read is rejected, which may be the slow one
      slow = dawdle();
    }
  };
  const auto refused = post_until(429);
  const auto problem = expect_problem(refused, 429);
  EXPECT_NE(problem.at("detail").get<std::string>().find("limit 750,000, request_buffer_bytes"),
            std::string::npos);
  EXPECT_EQ(refused->get_header_value("Retry-After"), "2");
  EXPECT_EQ(daemon.client().Post("/v1/scenes", small_scene().dump(), "application/json")->status, 201);
  slow.reset();
  expect_problem(post_until(400), 400);  // accepted, but not JSON
}

TEST(Disconnect, RemovesQueuedRender) {
  Daemon daemon(without_ray_limit({"--threads", "1", "--interactive-rays", "1000000000000"}));
  const std::string path = post(daemon, small_scene()) + "/frame.png";
  std::vector<std::unique_ptr<RawClient>> clients;
  for (int i = 0; i < 3; ++i) {  // two requests render, one waits
    clients.push_back(std::make_unique<RawClient>(daemon.port()));
    clients.back()->send(get(path + kEndless + "&seed=" + std::to_string(i)));
    ASSERT_TRUE(daemon.wait_until_working());
  }
  clients.clear();
  EXPECT_TRUE(daemon.wait_until_idle());
  EXPECT_EQ(daemon.metric("orrery_renders_waiting"), 0);
  EXPECT_EQ(daemon.client().Get(path)->status, 200);
}

TEST(Deadline, CancelsOverlongRender) {
  Daemon daemon(without_ray_limit({"--request-seconds", "1"}));
  const auto result = daemon.client().Get(post(daemon, small_scene()) + "/frame.png" + kEndless);
  const auto problem = expect_problem(result, 504);
  EXPECT_NE(problem.value("detail", "").find("request_seconds"), std::string::npos);
  EXPECT_TRUE(daemon.wait_until_idle());
}

// Returns the path of an image that takes about two seconds to render on this machine.
std::string slow_picture(Daemon& daemon, const std::string& scene) {
  const double before = daemon.cpu_seconds();
  daemon.client().Get(scene + "/frame.png?width=1000&height=1000&samples=4");
  const double seconds = std::max(daemon.cpu_seconds() - before, 0.02);
  const int samples = static_cast<int>(std::clamp(4 * 4 / seconds, 1.0, 4096.0));
  return scene + "/frame.png?width=1000&height=1000&seed=1&samples=" + std::to_string(samples);
}

// Runs a shell command and returns its output and exit status.
std::pair<std::string, int> run(const std::string& command) {
  FILE* const pipe = popen((command + " 2>&1").c_str(), "r");
  std::string text;
  for (int c; (c = std::fgetc(pipe)) != EOF;) text += static_cast<char>(c);
  return {text, WEXITSTATUS(pclose(pipe))};
}

TEST(Startup, RaisesDescriptorLimitOrFails) {
  const std::string check = "'" + program() + "' serve --check-config --connections ";
  const auto [text, status] = run("ulimit -n 500; " + check + "165");
  EXPECT_EQ(status, 2);
  EXPECT_NE(text.find("165 connections may need 501 open files (limit 500, ulimit -n)"), std::string::npos)
      << text;
  EXPECT_EQ(run("ulimit -n 500; " + check + "164"), std::pair(std::string(), 0));
  EXPECT_EQ(run("ulimit -Sn 64; " + check + "256"), std::pair(std::string(), 0));
}

TEST(Startup, RejectsTooSmallAddressSpace) {
  const std::string check = "'" + program() + "' serve --check-config --connections ";
  const std::string stacks = "ulimit -Ss 8192; ulimit -v ";  // in KiB
  const auto [addresses, refused] =
      run(stacks + "3000000; " + check + "8 --threads 2 --memory-bytes 3000000000");
  EXPECT_EQ(refused, 2);
  EXPECT_NE(addresses.find("3,000,000,000 bytes, 8 connections and 2 threads may need 3,603,979,776 bytes of "
                           "address space (limit 3,072,000,000, ulimit -v)"),
            std::string::npos)
      << addresses;
  EXPECT_EQ(run(stacks + "3519512; " + check + "8 --threads 2 --memory-bytes 3000000000"),
            std::pair(std::string(), 0));
}

// During the drain delay, the load balancer can notice that the service is not ready.
TEST(Shutdown, ServesRequestsDuringDrainDelay) {
  Daemon daemon({"--drain-delay-seconds", "3600"});
  const std::string scene = post(daemon, small_scene());
  EXPECT_EQ(daemon.health_client().Get("/readyz")->status, 200);
  daemon.signal(SIGTERM);
  EXPECT_TRUE(test::eventually([&] { return daemon.health_client().Get("/readyz")->status == 503; }));
  EXPECT_EQ(daemon.client().Get(scene + "/frame.png")->status, 200);
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 130);
}

TEST(Shutdown, ExitsAfterDrainDelay) {
  Daemon daemon({"--drain-delay-seconds", "1"});
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0);
}

// All threads block the signal from the start, those of the log included.
TEST(Shutdown, EndsOrderlyRightAfterStart) {
  for (int i = 0; i < 40; ++i) {
    Daemon daemon({"--drain-delay-seconds", "0"});
    daemon.signal(SIGTERM);
    ASSERT_EQ(daemon.wait(), 0) << i;
  }
}

TEST(Shutdown, FinishesRunningRequestsAndRejectsNewOnes) {
  Daemon daemon;
  const std::string scene = post(daemon, small_scene());
  const std::string path = slow_picture(daemon, scene);
  auto running = std::async(std::launch::async, [&] { return daemon.client().Get(path); });
  httplib::Client late = daemon.client();
  ASSERT_TRUE(daemon.wait_until_working());
  daemon.signal(SIGTERM);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const auto ready = late.Get("/readyz");
  ASSERT_TRUE(ready);
  EXPECT_EQ(ready->status, 503);
  const auto refused = daemon.client().Get(scene + "/frame.png");
  expect_problem(refused, 503);
  EXPECT_FALSE(refused->get_header_value("Retry-After").empty());
  const auto answer = running.get();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 200);
  EXPECT_TRUE(is_png(answer->body));
  EXPECT_EQ(daemon.wait(), 0);
}

TEST(Shutdown, EndsStreamsAtFrameBoundary) {
  Daemon daemon;
  const std::string path = post(daemon, small_scene()) + "/orbit?frames=3600&fps=30";
  std::string body;
  std::atomic<bool> begun{false};
  auto watching = std::async(std::launch::async, [&] {
    return daemon.client().Get(path, {{"Accept", "application/x-orrery-frames"}},
                               [&](const char* bytes, std::size_t count) {
                                 body.append(bytes, count);
                                 begun = true;
                                 return true;
                               });
  });
  EXPECT_TRUE(test::eventually([&] { return begun.load(); }));
  daemon.signal(SIGTERM);
  const auto answer = watching.get();
  EXPECT_TRUE(answer) << httplib::to_string(answer.error());
  const auto frames = parse_frames(body);
  EXPECT_GE(frames.size(), 1u);
  EXPECT_LT(frames.size(), 3600u);
  EXPECT_EQ(daemon.wait(), 0);
}

TEST(Shutdown, DoesNotWaitForIdleConnections) {
  Daemon daemon;
  httplib::Client idle = daemon.client();
  EXPECT_EQ(idle.Get("/healthz")->status, 200);
  const RawClient silent(daemon.port());
  daemon.signal(SIGINT);
  EXPECT_EQ(daemon.wait(), 0);
}

TEST(Shutdown, CancelsRequestsAfterGracePeriod) {
  Daemon daemon(without_ray_limit({"--grace-seconds", "1"}));
  const std::string path = post(daemon, small_scene()) + "/frame.png" + kEndless;
  auto running = std::async(std::launch::async, [&] { return daemon.client().Get(path); });
  ASSERT_TRUE(daemon.wait_until_working());
  daemon.signal(SIGTERM);
  expect_problem(running.get(), 503);
  EXPECT_EQ(daemon.wait(), 0);
}

TEST(Shutdown, ExitsAtOnceOnSecondSignal) {
  Daemon daemon(without_ray_limit());
  RawClient raw(daemon.port());
  raw.send(get(post(daemon, small_scene()) + "/frame.png" + kEndless));
  ASSERT_TRUE(daemon.wait_until_working());
  daemon.signal(SIGTERM);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_TRUE(daemon.running());
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 130);
}

TEST(Startup, RequiresInsecureFlagForPublicAddress) {
  EXPECT_EQ(WEXITSTATUS(std::system((program() + " serve --port 0 --host 0.0.0.0 2>/dev/null").c_str())), 2);
  Daemon daemon({"--host", "0.0.0.0", "--insecure"});
  EXPECT_EQ(daemon.client().Get("/healthz")->status, 200);
}

TEST(Startup, FailsIfPortIsInUse) {
  Daemon daemon;
  const std::string command =
      program() + " serve --health-port 0 --port " + std::to_string(daemon.port()) + " 2>/dev/null";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 1);
}

}  // namespace
}  // namespace orrery
