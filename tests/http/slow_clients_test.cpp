#include <memory>
#include <thread>

#include "tests/http/daemon.h"

// Tests clients that keep connections open without progress. Other clients must be served, and no resource
// may leak.
namespace orrery {
namespace {

using Clients = std::vector<std::unique_ptr<RawClient>>;

constexpr int kConnections = 8;

class SlowClients : public ::testing::Test {
 protected:
  // Opens twice as many connections as allowed and sends `bytes` on each. The connections of the second half
  // evict those of the first.
  Clients open(const std::string& bytes, int receive_buffer = 0) {
    Clients clients;
    for (int i = 0; i < 2 * kConnections; ++i) {
      clients.push_back(std::make_unique<RawClient>(daemon_.port(), receive_buffer));
      clients.back()->send(bytes);
      pause();
    }
    return clients;
  }

  void expect_others_are_served() {
    for (int i = 0; i < 2 * kConnections; ++i) {
      const RawClient raw(daemon_.port());
      raw.send("GET /healthz HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
      EXPECT_EQ(raw.receive_all().substr(0, 12), "HTTP/1.1 200") << i;
    }
    EXPECT_EQ(daemon_.metric("orrery_connections_refused_total"), 0);
  }

  void expect_descriptors_come_back(std::size_t before) {
    for (int i = 0; i < 400 && daemon_.open_files() > before; ++i) pause();
    EXPECT_LE(daemon_.open_files(), before);
  }

  // Sleeps longer than the idle timeout of a connection while others wait.
  static void pause() { std::this_thread::sleep_for(std::chrono::milliseconds(50)); }

  Daemon daemon_{{"--connections", std::to_string(kConnections)}};
};

TEST_F(SlowClients, EvictsSilentClients) {
  const std::size_t before = daemon_.open_files();
  Clients clients = open("");
  expect_others_are_served();
  clients.clear();
  expect_descriptors_come_back(before);
}

TEST_F(SlowClients, EvictsClientsWithSlowHeads) {
  const std::size_t before = daemon_.open_files();
  Clients clients = open("GET /healthz HTTP/1.1\r\nHost: x\r\n");
  clients.back()->send("A: b\r\n");
  expect_others_are_served();
  const std::string answer = clients.front()->receive_all();  // the oldest connection was evicted first
  EXPECT_EQ(answer.substr(0, 12), "HTTP/1.1 408");
  EXPECT_NE(answer.find("(connections)"), std::string::npos) << answer;
  clients.clear();
  expect_descriptors_come_back(before);
}

TEST_F(SlowClients, EvictsClientsWithSlowBodies) {
  const std::size_t before = daemon_.open_files();
  Clients clients = open("POST /v1/scenes HTTP/1.1\r\nHost: x\r\nContent-Length: 5000\r\n\r\n{");
  expect_others_are_served();
  const std::string answer = clients.front()->receive_all();
  EXPECT_EQ(answer.substr(0, 12), "HTTP/1.1 408");
  EXPECT_NE(answer.find("(connections)"), std::string::npos) << answer;
  clients.clear();
  expect_descriptors_come_back(before);
}

TEST_F(SlowClients, EvictsClientsThatDoNotRead) {
  const std::size_t before = daemon_.open_files();
  // Requests more bytes than both kernel buffers can store, and reads none.
  std::string requests;
  for (int i = 0; i < 200; ++i) requests += "GET /scenes/sphereflake-3.json HTTP/1.1\r\nHost: x\r\n\r\n";
  Clients clients = open(requests, 4096);
  expect_others_are_served();
  clients.clear();
  expect_descriptors_come_back(before);
}

TEST_F(SlowClients, EvictsRejectedClientsWithIncompleteBodies) {
  const std::size_t before = daemon_.open_files();
  Clients clients = open("POST /nosuch HTTP/1.1\r\nHost: x\r\nContent-Length: 5000\r\n\r\n{");
  expect_others_are_served();
  clients.clear();
  expect_descriptors_come_back(before);
}

TEST_F(SlowClients, DoesNotEvictActiveClients) {
  const auto posted = daemon_.client().Post("/v1/scenes", small_scene().dump(), "application/json");
  const std::string id = nlohmann::json::parse(posted->body).at("id");
  const RawClient viewer(daemon_.port());
  viewer.send("GET /v1/scenes/" + id +
              "/orbit?frames=20&fps=10 HTTP/1.1\r\nHost: x\r\nAccept: application/x-orrery-frames\r\n"
              "Connection: close\r\n\r\n");
  std::string body = viewer.receive_some();
  const Clients clients = open("GET /");
  expect_others_are_served();
  body += viewer.receive_all();
  EXPECT_TRUE(body.ends_with("\r\n0\r\n\r\n"));
}

}  // namespace
}  // namespace orrery
