#include <fstream>

#include "tests/http/daemon.h"

// Tests the service behind a proxy.
namespace orrery {
namespace {

const std::vector<std::string> kBehindProxy{"--path-prefix", "/render", "--trusted-proxies", "127.0.0.1"};

TEST(Proxy, ServesWithAndWithoutPrefix) {
  const Daemon daemon(kBehindProxy);
  auto client = daemon.client();
  for (const char* path : {"/v1/limits", "/render/v1/limits", "/", "/render/", "/render/healthz"})
    EXPECT_EQ(client.Get(path)->status, 200) << path;
  const auto folder = client.Get("/render");
  EXPECT_EQ(folder->status, 308);
  EXPECT_EQ(folder->get_header_value("Location"), "/render/");
  EXPECT_EQ(client.Get("/render?scene=7&t=0.5")->get_header_value("Location"), "/render/?scene=7&t=0.5");
  expect_problem(client.Get("/other/v1/limits"), 404);
  expect_problem(client.Get("/renderv1/limits"), 404);
}

TEST(Proxy, PrefixesLinks) {
  const Daemon daemon(kBehindProxy);
  auto client = daemon.client();
  const std::string scene = small_scene().dump();
  const auto kept = client.Post("/render/v1/scenes", scene, "application/json");
  ASSERT_TRUE(kept);
  const std::string location = kept->get_header_value("Location");
  EXPECT_EQ(location.substr(0, 18), "/render/v1/scenes/");
  EXPECT_EQ(client.Get(location)->status, 200);
  const auto started = client.Post("/v1/jobs", {{"X-Forwarded-Prefix", "/other"}},
                                   "{\"scene\": " + scene + "}", "application/json");
  ASSERT_TRUE(started);
  EXPECT_EQ(started->get_header_value("Location").substr(0, 15), "/other/v1/jobs/");
  const auto job = nlohmann::json::parse(started->body);
  for (const char* link : {"events", "first_frame"})
    EXPECT_EQ(job.at(link).get<std::string>().substr(0, 15), "/other/v1/jobs/") << link;
  const std::string id = job.at("id");
  const auto events = client.Get("/render/v1/jobs/" + id + "/events");
  ASSERT_TRUE(events);
  EXPECT_NE(events->body.find("\"href\":\"/render/v1/jobs/" + id + "/frames/0.png\""), std::string::npos)
      << events->body;
  EXPECT_EQ(client.Get("/render/v1/jobs/" + id + "/frames/0.png")->status, 200);
}

// A signature is valid with and without the prefix, whether the proxy or the service strips it.
TEST(Proxy, AcceptsSharedLinksWithAndWithoutPrefix) {
  const std::string key = ::testing::TempDir() + "proxy_share_key";
  std::ofstream(key) << std::string(32, 'k');
  std::vector<std::string> arguments = kBehindProxy;
  arguments.insert(arguments.end(), {"--link-signing-key-file", key});
  const Daemon daemon(arguments);
  auto client = daemon.client();
  for (const char* path : {"/v1/limits", "/render/v1/limits"}) {
    const auto share = client.Post("/v1/shares", nlohmann::json{{"path", path}}.dump(), "application/json");
    ASSERT_EQ(share->status, 201) << share->body;
    const std::string link = nlohmann::json::parse(share->body).at("href");
    EXPECT_EQ(link.substr(0, 18), "/render/v1/limits?");
    EXPECT_EQ(client.Get(link)->status, 200);
    EXPECT_EQ(client.Get(link.substr(7))->status, 200);
  }
}

// A page on a domain that resolves to this machine (DNS rebinding) can send any header.
TEST(Proxy, ChecksBothHostAndForwardedHost) {
  const Daemon daemon({"--trusted-proxies", "127.0.0.1", "--cors-origins", "https://render.example"});
  auto client = daemon.client();
  const auto get = [&](const char* host, const char* told) {
    return client.Get("/v1/limits", {{"Host", host}, {"X-Forwarded-Host", told}});
  };
  expect_problem(get("evil.example", "localhost"), 403);
  expect_problem(get("localhost", "evil.example"), 403);
  EXPECT_EQ(get("localhost", "render.example")->status, 200);
  const auto post = client.Post(
      "/v1/scenes", {{"X-Forwarded-Host", "render.example"}, {"Origin", "https://render.example"}},
      small_scene().dump(), "application/json");
  EXPECT_EQ(post->status, 201);
}

// One client may run half of the jobs. Two clients behind one proxy have separate quotas.
TEST(Proxy, SeparatesQuotasOfForwardedClients) {
  const Daemon daemon({"--trusted-proxies", "127.0.0.1", "--jobs", "2"});
  auto client = daemon.client();
  const auto start = [&](const char* who, int width) {
    const nlohmann::json job{{"scene", small_scene({{"image", {{"width", width}, {"height", 3000}}}})},
                             {"render", {{"samples", 4096}, {"precision", "double"}}}};
    return client.Post("/v1/jobs", {{"X-Forwarded-For", who}}, job.dump(), "application/json")->status;
  };
  EXPECT_EQ(start("198.51.100.1", 3000), 202);
  EXPECT_EQ(start("203.0.113.9, 198.51.100.1", 3001), 429);  // the client's own entry is ignored
  EXPECT_EQ(start("198.51.100.2", 3002), 202);
}

}  // namespace
}  // namespace orrery
