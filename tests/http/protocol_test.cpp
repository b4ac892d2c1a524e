#include <algorithm>
#include <thread>

#include "tests/http/daemon.h"
#include "tests/support/eventually.h"

// Tests requests that HTTP libraries cannot send.
namespace orrery {
namespace {

class Protocol : public HttpTest {
 protected:
  // Returns the status of the response to `bytes`, or 0 without a response. The daemon must close the
  // connection.
  int status_of(const std::string& bytes) {
    const RawClient raw(daemon().port());
    raw.send(bytes);
    const std::string answer = raw.receive_all();
    if (answer.rfind("HTTP/1.1 ", 0) != 0) return 0;
    EXPECT_NE(answer.find("application/problem+json"), std::string::npos) << answer;
    EXPECT_NE(answer.find("Connection: close"), std::string::npos) << answer;
    return std::stoi(answer.substr(9));
  }
};

// Sends the bytes individually.
TEST_F(Protocol, AcceptsChunkedBodies) {
  const std::string scene = small_scene().dump();
  char size[20];
  std::snprintf(size, sizeof size, "%zx", scene.size());
  const RawClient raw(daemon().port());
  raw.send("POST /v1/scenes HTTP/1.1\r\nHost: x\r\nConnection: close\r\nTransfer-Encoding: chunked\r\n\r\n");
  for (const char c : size + ("\r\n" + scene) + "\r\n0\r\nA: b\r\n\r\n") raw.send(std::string(1, c));
  const std::string answer = raw.receive_all();
  EXPECT_EQ(answer.substr(9, 2), "20") << answer;
}

TEST_F(Protocol, RejectsBodiesWithoutLength) {
  const RawClient raw(daemon().port());
  raw.send("POST /v1/scenes HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
  EXPECT_EQ(raw.receive_all().substr(9, 3), "411");
}

TEST_F(Protocol, RejectsAmbiguousFraming) {
  const std::string line = "POST /v1/render HTTP/1.1\r\nHost: x\r\n";
  EXPECT_EQ(status_of(line + "Content-Length: 2\r\nContent-Length: 3\r\n\r\n{}"), 400);
  EXPECT_EQ(status_of(line + "Content-Length: 2\r\nTransfer-Encoding: chunked\r\n\r\n{}"), 400);
  EXPECT_EQ(status_of(line + "Content-Length: -1\r\n\r\n"), 400);
  EXPECT_EQ(status_of(line + "Content-Length: 2, 2\r\n\r\n{}"), 400);
  EXPECT_EQ(status_of(line + "Content-Length: 99999999999999999999\r\n\r\n"), 400);
  EXPECT_EQ(status_of(line + "Content-Length : 2\r\n\r\n{}"), 400);
  EXPECT_EQ(status_of(line + "A: b\r\n folded: c\r\n\r\n"), 400);
}

TEST_F(Protocol, RejectsInvalidRequests) {
  EXPECT_EQ(status_of("hello\r\n\r\n"), 400);
  EXPECT_EQ(status_of("GET / HTTP/1.1\r\n\r\n"), 400);  // no Host
  EXPECT_EQ(status_of("GET nopath HTTP/1.1\r\nHost: x\r\n\r\n"), 400);
  EXPECT_EQ(status_of("BREW / HTTP/1.1\r\nHost: x\r\n\r\n"), 501);
  EXPECT_EQ(status_of("GET / HTTP/2.0\r\nHost: x\r\n\r\n"), 505);
}

TEST_F(Protocol, LimitsHeadSize) {
  EXPECT_EQ(status_of("GET /" + std::string(3000, 'a') + " HTTP/1.1\r\nHost: x\r\n\r\n"), 414);
  EXPECT_EQ(status_of("GET / HTTP/1.1\r\nHost: x\r\nA: " + std::string(20'000, 'a') + "\r\n\r\n"), 431);
  std::string many;
  for (int i = 0; i < 200; ++i) many += "A: b\r\n";
  EXPECT_EQ(status_of("GET / HTTP/1.1\r\nHost: x\r\n" + many + "\r\n"), 431);
}

TEST_F(Protocol, DoesNotParseUnreadBodyAsRequest) {
  const RawClient raw(daemon().port());
  const std::string inner = "GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n";
  raw.send("POST /nosuch HTTP/1.1\r\nHost: x\r\nContent-Length: " + std::to_string(inner.size()) +
           "\r\n\r\n" + inner);
  const std::string answer = raw.receive_all();
  EXPECT_EQ(answer.substr(9, 3), "404");
  EXPECT_EQ(answer.find("HTTP/1.1", 1), std::string::npos) << answer;
}

TEST_F(Protocol, AnswersPipelinedRequestsInOrder) {
  const RawClient raw(daemon().port());
  raw.send(
      "GET /healthz HTTP/1.1\r\nHost: x\r\n\r\nGET /nosuch HTTP/1.1\r\nHost: x\r\n\r\n"
      "GET /readyz HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
  const std::string answer = raw.receive_all();
  const std::size_t first = answer.find("200 OK"), second = answer.find("404 "),
                    third = answer.rfind("200 OK");
  EXPECT_LT(first, second);
  EXPECT_LT(second, third);
}

TEST_F(Protocol, SendsContinueOnExpect) {
  const RawClient raw(daemon().port());
  const std::string scene = small_scene().dump();
  raw.send(
      "POST /v1/render HTTP/1.1\r\nHost: x\r\nExpect: 100-continue\r\nConnection: close\r\nContent-Length: " +
      std::to_string(scene.size()) + "\r\n\r\n");
  EXPECT_EQ(raw.receive_some(), "HTTP/1.1 100 Continue\r\n\r\n");
  raw.send(scene);
  EXPECT_EQ(raw.receive_all().substr(9, 3), "200");
}

TEST_F(Protocol, EndsHttp10StreamsByClosing) {
  const std::string id = post_scene(small_scene().dump());
  const RawClient raw(daemon().port());
  raw.send("GET /v1/scenes/" + id +
           "/orbit?frames=2&fps=0 HTTP/1.0\r\nAccept: application/x-orrery-frames\r\n\r\n");
  const std::string answer = raw.receive_all();
  EXPECT_EQ(answer.find("Transfer-Encoding"), std::string::npos);
  EXPECT_EQ(parse_frames(answer.substr(answer.find("\r\n\r\n") + 4)).size(), 2u);
}

TEST(Connections, RejectsConnectionsOverLimit) {
  Daemon daemon(without_ray_limit({"--connections", "2"}));
  const auto posted = daemon.client().Post("/v1/scenes", small_scene().dump(), "application/json");
  const std::string id = nlohmann::json::parse(posted->body).at("id");
  ASSERT_TRUE(test::eventually([&] { return daemon.metric("orrery_connections") == 0; }));
  const RawClient first(daemon.port()), second(daemon.port());  // busy connections are not evicted
  const std::string path = "/v1/scenes/" + id + "/frame.png?width=4096&height=4096&samples=4096";
  first.send("GET " + path + "&seed=1 HTTP/1.1\r\nHost: x\r\n\r\n");
  second.send("GET " + path + "&seed=2 HTTP/1.1\r\nHost: x\r\n\r\n");
  ASSERT_TRUE(test::eventually([&] {
    return daemon.metric("orrery_renders_running") + daemon.metric("orrery_renders_waiting") == 2;
  }));
  const RawClient third(daemon.port());
  const std::string answer = third.receive_all();
  EXPECT_EQ(answer.substr(0, 34), "HTTP/1.1 503 Service Unavailable\r\n");
  EXPECT_NE(answer.find("\r\nRetry-After: 1\r\n"), std::string::npos);
  EXPECT_NE(answer.find("\r\nContent-Type: application/problem+json\r\n"), std::string::npos);
  const auto problem = nlohmann::json::parse(answer.substr(answer.find("\r\n\r\n") + 4));
  EXPECT_EQ(problem.at("detail"), "2 connections are open (limit 2, connections)");
  EXPECT_NE(answer.find("\r\nX-Request-ID: " + problem.at("request_id").get<std::string>() + "\r\n"),
            std::string::npos);
}

constexpr std::uint8_t kGreedy = 2, kOther = 3;  // addresses 127.0.0.X
const std::string kHealth = "GET /healthz HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n";

std::string health_from(const Daemon& daemon, std::uint8_t address) {
  const RawClient raw(daemon.port(), 0, address);
  raw.send(kHealth);
  return raw.receive_all();
}

TEST(Connections, LimitsOneAddressToThreeQuarters) {
  Daemon daemon(without_ray_limit({"--connections", "8", "--max-queued-rays", "1000000000000"}));
  const auto posted = daemon.client().Post("/v1/scenes", small_scene().dump(), "application/json");
  const std::string id = nlohmann::json::parse(posted->body).at("id");
  std::vector<std::unique_ptr<RawClient>> at_work;  // busy connections are not evicted
  for (int i = 0; i < 6; ++i) {
    at_work.push_back(std::make_unique<RawClient>(daemon.port(), 0, kGreedy));
    at_work.back()->send("GET /v1/scenes/" + id + "/frame.png?width=4096&height=4096&samples=4096&seed=" +
                         std::to_string(i) + " HTTP/1.1\r\nHost: x\r\n\r\n");
  }
  ASSERT_TRUE(test::eventually([&] {
    return daemon.metric("orrery_renders_running") + daemon.metric("orrery_renders_waiting") == 6;
  }));
  const std::string refused = health_from(daemon, kGreedy);
  EXPECT_EQ(refused.substr(0, 12), "HTTP/1.1 429");
  EXPECT_NE(refused.find("6 connections from this address are open (limit 6 per address, connections)"),
            std::string::npos)
      << refused;
  EXPECT_EQ(health_from(daemon, kOther).substr(0, 12), "HTTP/1.1 200");
}

// Two addresses use all connections, and most of their requests are queued.
TEST(Connections, EvictsQueuedRequestsForNewClients) {
  Daemon daemon(
      without_ray_limit({"--connections", "8", "--threads", "1", "--max-queued-rays", "1000000000000"}));
  const auto posted = daemon.client().Post("/v1/scenes", small_scene().dump(), "application/json");
  const std::string id = nlohmann::json::parse(posted->body).at("id");
  ASSERT_TRUE(test::eventually([&] { return daemon.metric("orrery_connections") == 0; }));
  std::vector<std::unique_ptr<RawClient>> holders;
  for (int i = 0; i < 8; ++i) {
    holders.push_back(std::make_unique<RawClient>(daemon.port(), 0, i < 5 ? kGreedy : kOther));
    holders.back()->send("GET /v1/scenes/" + id + "/frame.png?width=4096&height=4096&samples=512&seed=" +
                         std::to_string(i) + " HTTP/1.1\r\nHost: x\r\n\r\n");
    const auto at_work = [&] {
      return daemon.metric("orrery_renders_running") + daemon.metric("orrery_renders_waiting");
    };
    ASSERT_TRUE(test::eventually([&] { return at_work() == i + 1; })) << i << " " << at_work();
  }
  EXPECT_EQ(daemon.health_client().Get("/readyz")->status, 200);
  const RawClient newcomer(daemon.port(), 0, 4);
  newcomer.send("GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n");
  EXPECT_EQ(newcomer.receive_some().substr(0, 12), "HTTP/1.1 200");
  // Newest request of the address with the most connections.
  const std::string evicted = holders[4]->receive_all();
  EXPECT_EQ(evicted.substr(0, 12), "HTTP/1.1 429");
  EXPECT_NE(evicted.find("\r\nRetry-After: "), std::string::npos);
  EXPECT_NE(evicted.find("(connections)"), std::string::npos) << evicted;
}

TEST(Connections, ReportsFullIfAllConnectionsAreBusy) {
  Daemon daemon(without_ray_limit({"--connections", "2"}));
  const auto posted = daemon.client().Post("/v1/scenes", small_scene().dump(), "application/json");
  const std::string id = nlohmann::json::parse(posted->body).at("id");
  ASSERT_TRUE(test::eventually([&] { return daemon.metric("orrery_connections") == 0; }));
  const RawClient first(daemon.port(), 0, kGreedy), second(daemon.port(), 0, kOther);
  const std::string path = "/v1/scenes/" + id + "/frame.png?width=4096&height=4096&samples=4096";
  first.send("GET " + path + "&seed=1 HTTP/1.1\r\nHost: x\r\n\r\n");
  second.send("GET " + path + "&seed=2 HTTP/1.1\r\nHost: x\r\n\r\n");
  ASSERT_TRUE(test::eventually([&] { return daemon.metric("orrery_renders_running") == 2; }));
  const auto ready = daemon.health_client().Get("/readyz");
  EXPECT_EQ(ready->status, 503);
  EXPECT_EQ(nlohmann::json::parse(ready->body).at("status"), "full");
}

// The idle connections of one address are evicted for other clients without delay.
TEST(Connections, EvictsIdleBurstForNewClients) {
  Daemon daemon({"--connections", "8"});
  std::vector<std::unique_ptr<RawClient>> burst, others;
  for (int i = 0; i < 6; ++i) burst.push_back(std::make_unique<RawClient>(daemon.port(), 0, kGreedy));
  for (int i = 0; i < 4; ++i) others.push_back(std::make_unique<RawClient>(daemon.port(), 0, kOther));
  for (const auto& other : others) {  // these connections stay open
    other->send("GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n");
    EXPECT_EQ(other->receive_some().substr(0, 12), "HTTP/1.1 200");
  }
  const auto stayed = std::count_if(burst.begin(), burst.end(), [](const auto& client) {
    client->send(kHealth);
    return client->receive_all().starts_with("HTTP/1.1 200");
  });
  EXPECT_EQ(stayed, 4) << "two connections were evicted";
}

}  // namespace
}  // namespace orrery
