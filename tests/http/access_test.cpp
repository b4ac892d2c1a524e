#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "core/base/hash.h"
#include "tests/http/daemon.h"
#include "tests/support/eventually.h"

// Tests access control: tokens, scopes, cross-origin requests and signed links.
namespace orrery {
namespace {

using nlohmann::json;

class Folder {
 public:
  Folder() { std::filesystem::create_directory(path_); }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return path_ / name;
  }

 private:
  const std::filesystem::path path_ =
      std::filesystem::temp_directory_path() / ("orrery-access-" + std::to_string(getpid()));
};

std::string line(const std::string& name, const std::string& scopes, const std::string& token) {
  return name + " " + scopes + " " + sha256_hex(token) + "\n";
}

httplib::Headers bearer(const std::string& token) { return {{"Authorization", "Bearer " + token}}; }

struct TokenDaemon {
  Folder folder;
  std::string tokens = folder.write(
      "tokens", "# people\n" + line("reader", "read", "r") + line("painter", "read,render", "p") + "\n" +
                    line("keeper", "read,write", "k") + line("filler", "write", "w") +
                    line("boss", "read,render,write,admin", "b"));
  std::string key = folder.write("key", std::string(32, 'k'));
  Daemon daemon{{"--tokens-file", tokens, "--link-signing-key-file", key}};
  httplib::Client client = daemon.client();
};

TEST(Access, RequiresTokenWithScope) {
  TokenDaemon guarded;
  auto& client = guarded.client;
  const std::string scene = small_scene().dump();
  const auto post = [&](const char* path, const std::string& token, const std::string& body) {
    return client.Post(path, bearer(token), body, "application/json");
  };
  const auto refused = client.Get("/v1/limits");
  expect_problem(refused, 401);
  EXPECT_EQ(refused->get_header_value("WWW-Authenticate"), "Bearer");
  const auto unknown = client.Get("/v1/limits", bearer("x"));
  expect_problem(unknown, 401);
  EXPECT_EQ(unknown->get_header_value("WWW-Authenticate"), "Bearer error=\"invalid_token\"");
  for (const char* strange : {"r", "Basic r", "Bearer", "Bearer ", "Bearer r r", "bearer  r"})
    expect_problem(client.Get("/v1/limits", {{"Authorization", strange}}), 401);
  EXPECT_EQ(client.Get("/v1/limits", {{"Authorization", "bearer r"}})->status, 200);
  expect_problem(post("/v1/scenes", "r", scene), 403);
  expect_problem(post("/v1/render", "r", scene), 403);
  expect_problem(post("/v1/scenes", "p", scene), 403);
  const auto rendered = post("/v1/render", "p", scene);
  EXPECT_EQ(rendered->status, 200);
  const std::string cached = "/v1/scenes/" + rendered->get_header_value("Orrery-Scene-Id");
  expect_problem(client.Get(cached), 401);
  EXPECT_EQ(client.Get(cached, bearer("r"))->status, 200);
  expect_problem(client.Delete(cached, bearer("p")), 403);
  const auto kept = post("/v1/scenes", "k", scene);
  EXPECT_EQ(kept->status, 201);
  const std::string charts = kept->get_header_value("Location") + "/charts";
  expect_problem(post(charts.c_str(), "k", "{}"), 403);
  EXPECT_EQ(post(charts.c_str(), "p", "{}")->status, 202);
  expect_problem(post("/v1/render", "k", scene), 403);
  expect_problem(post("/v1/jobs", "k", scene), 403);
  expect_problem(client.Delete("/v1/scenes/x", bearer("p")), 403);
  EXPECT_EQ(client.Head("/v1/limits")->status, 401);
  EXPECT_EQ(client.Head("/v1/limits", bearer("r"))->status, 200);
  expect_problem(client.Delete("/v1/jobs/x", bearer("k")), 403);
  expect_problem(client.Delete("/v1/jobs/x", bearer("p")), 404);
  const auto share = expect_problem(post("/v1/shares", "w", R"({"path": "/v1/limits"})"), 403);
  EXPECT_EQ(share.at("detail"), "token lacks scope read");
  const std::string kept_path = kept->get_header_value("Location");
  expect_problem(client.Delete(kept_path, bearer("w")), 403);
  EXPECT_EQ(client.Delete(kept_path, bearer("k"))->status, 204);
  const auto job = post("/v1/jobs", "p", nlohmann::json({{"scene", small_scene()}}).dump());
  const std::string job_path = job->get_header_value("Location");
  EXPECT_EQ(client.Delete(job_path, bearer("b"))->status, 204);
  post("/v1/scenes", "k", scene);
  const std::string chosen = cached + "/frame.png?accelerator=list";
  const auto choice = expect_problem(client.Get(chosen, bearer("r")), 403);
  EXPECT_EQ(choice.at("detail"), "token lacks scope render, which the parameter accelerator needs");
  EXPECT_EQ(client.Get(chosen, bearer("p"))->status, 200);
  expect_problem(post("/v1/shares", "k", nlohmann::json({{"path", chosen}}).dump()), 403);
  EXPECT_EQ(post("/v1/shares", "k", nlohmann::json({{"path", cached}}).dump())->status, 201);
  for (const char* path : {"/v1/nothing", "/v1/render", "/v1/jobs/x/nothing"})
    expect_problem(post("/v1/shares", "k", nlohmann::json({{"path", path}}).dump()), 422);
  for (const char* open :
       {"/", "/app.js", "/schemas/scene.json", "/healthz", "/readyz", "/scenes/paper.json"})
    EXPECT_EQ(client.Get(open)->status, 200) << open;
}

TEST(Access, ReloadsTokensOnSighup) {
  TokenDaemon guarded;
  const auto status = [&](const std::string& token) {
    return guarded.client.Get("/v1/limits", bearer(token))->status;
  };
  const auto becomes = [&](const std::string& token, int wanted) {
    for (int i = 0; i < 200 && status(token) != wanted; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return status(token);
  };
  EXPECT_EQ(status("r"), 200);
  guarded.folder.write("tokens", line("other", "read", "o"));
  guarded.daemon.signal(SIGHUP);
  EXPECT_EQ(becomes("o", 200), 200);
  EXPECT_EQ(status("r"), 401);
  guarded.folder.write("tokens", line("other", "read,paint", "o"));  // "paint" is not a scope
  guarded.daemon.signal(SIGHUP);
  EXPECT_TRUE(test::eventually([&] { return guarded.daemon.metric("orrery_reload_failures_total") == 1; }));
  EXPECT_EQ(status("o"), 200);
}

TEST(Settings, ReloadsOriginsOnSighup) {
  const Folder folder;
  const auto write = [&](const json& settings) { return folder.write("settings.json", settings.dump()); };
  const std::string file = write({{"cors_origins", {"https://one.example"}}});
  const Daemon daemon({"--config", file});
  auto client = daemon.client();
  const auto is_allowed = [&](const char* origin) {
    return client.Get("/v1/limits", {{"Origin", origin}})->has_header("Access-Control-Allow-Origin");
  };
  EXPECT_TRUE(is_allowed("https://one.example"));
  write({{"cors_origins", {"https://two.example"}}, {"jobs", 7}});
  daemon.signal(SIGHUP);
  EXPECT_TRUE(test::eventually([&] { return is_allowed("https://two.example"); }));
  EXPECT_FALSE(is_allowed("https://one.example"));
  EXPECT_NE(json::parse(client.Get("/v1/limits")->body).at("jobs"), 7);  // `jobs` needs a restart
  // A changed `tokens_file` needs a restart, so the reload does not open it.
  write({{"cors_origins", {"https://one.example"}}, {"tokens_file", "/nowhere"}});
  daemon.signal(SIGHUP);
  EXPECT_TRUE(test::eventually([&] { return is_allowed("https://one.example"); }));
  write({{"cors_origins", {"https://three.example"}}, {"jobs", "many"}});
  daemon.signal(SIGHUP);
  EXPECT_TRUE(test::eventually([&] { return daemon.metric("orrery_reload_failures_total") == 1; }));
  EXPECT_FALSE(is_allowed("https://three.example"));
}

TEST(Access, AcceptsSignedLinksUntilExpiry) {
  TokenDaemon guarded;
  auto& client = guarded.client;
  const auto posted = client.Post("/v1/scenes", bearer("k"), small_scene().dump(), "application/json");
  const std::string frame = posted->get_header_value("Location") + "/frame.png?azimuth=30";
  const auto share = [&](const json& body) {
    return client.Post("/v1/shares", bearer("k"), body.dump(), "application/json");
  };
  const json shared = json::parse(share({{"path", frame}})->body);
  const std::string link = shared.at("href");
  expect_problem(client.Get(frame), 401);
  const auto picture = client.Get(link);
  EXPECT_EQ(picture->status, 200);
  EXPECT_EQ(picture->body, client.Get(frame, bearer("r"))->body);
  EXPECT_EQ(picture->get_header_value("ETag"), client.Get(frame, bearer("r"))->get_header_value("ETag"));
  EXPECT_EQ(picture->get_header_value("Cache-Control"), "private, no-cache");
  EXPECT_EQ(client.Get(frame, bearer("r"))->get_header_value("Cache-Control"),
            "private, max-age=31536000, immutable");
  std::string turned = link, longer = link, tampered = link;
  turned.replace(turned.find("azimuth=30"), 10, "azimuth=31");
  longer.replace(longer.find("expires=") + 8, 1, "9");
  tampered.back() = tampered.back() == '0' ? '1' : '0';
  for (const std::string& wrong : {turned, longer, tampered, link + "&samples=4", frame + "&signature="})
    expect_problem(client.Get(wrong), 403);
  expect_problem(client.Delete(posted->get_header_value("Location") + link.substr(link.find('?'))), 401);
  const std::string brief = json::parse(share({{"path", frame}, {"seconds", 1}})->body).at("href");
  int status = 0;
  for (int i = 0; i < 200 && status != 403; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    status = client.Get(brief)->status;
  }
  EXPECT_EQ(status, 403);
  expect_problem(share({{"path", "/healthz"}}), 422);
  expect_problem(share({{"path", "/v1/%zz"}}), 422);
  expect_problem(share({{"path", frame}, {"seconds", 0}}), 422);
  for (const char* wrong : {"/v1/limits#a", "/v1/limits?expires=5", "/v1/limits?signature=5", "/v1/a b"})
    expect_problem(share({{"path", wrong}}), 422);
}

TEST(Access, PreventsStartWithInvalidFiles) {
  Folder folder;
  const auto status_of = [&](const std::string& option, const std::string& file) {
    const std::string command = program() + " serve --check-config " + option + " " + file + " 2>/dev/null";
    return WEXITSTATUS(std::system(command.c_str()));
  };
  const auto status_with = [&](const std::string& option, const std::string& text) {
    return status_of(option, folder.write("file", text));
  };
  EXPECT_EQ(status_with("--tokens-file", line("alice", "read", "a")), 0);
  EXPECT_EQ(status_with("--tokens-file", "alice read\n"), 2);
  EXPECT_EQ(status_with("--tokens-file", line("alice", "paint", "a")), 2);
  EXPECT_EQ(status_with("--tokens-file", "# nobody\n"), 2);
  EXPECT_EQ(status_with("--tokens-file", "alice read " + sha256_hex("a").substr(1) + "\n"), 2);
  EXPECT_EQ(status_with("--link-signing-key-file", std::string(32, 'k')), 0);
  EXPECT_EQ(status_with("--link-signing-key-file", std::string(31, 'k')), 2);
  EXPECT_EQ(status_of("--tokens-file", "/nonexistent"), 2);
}

TEST(Cors, AllowsOnlyListedOrigins) {
  Daemon daemon({"--cors-origins", "https://a.example,https://b.example"});
  auto client = daemon.client();
  const auto get = [&](const std::string& origin) { return client.Get("/v1/limits", {{"Origin", origin}}); };
  for (const char* origin : {"https://a.example", "https://b.example"}) {
    EXPECT_EQ(get(origin)->get_header_value("Access-Control-Allow-Origin"), origin);
    for (const char* exposed : {"Retry-After", "Orrery-RMSE", "X-RMSE"})
      EXPECT_NE(get(origin)->get_header_value("Access-Control-Expose-Headers").find(exposed),
                std::string::npos)
          << exposed;
  }
  for (const char* origin : {"https://c.example", "http://a.example", "null", "https://a.example.evil"})
    EXPECT_FALSE(get(origin)->has_header("Access-Control-Allow-Origin")) << origin;
  EXPECT_EQ(get("x")->get_header_value("Vary"), "Accept-Encoding, Origin");
  const httplib::Headers ask{
      {"Origin", "https://a.example"}, {"Access-Control-Request-Method", "PUT"}, {"Connection", "close"}};
  const auto preflight = client.Options("/v1/assets/x", ask);
  EXPECT_EQ(preflight->status, 204);
  EXPECT_EQ(preflight->get_header_value("Access-Control-Allow-Origin"), "https://a.example");
  EXPECT_NE(preflight->get_header_value("Access-Control-Allow-Methods").find("PUT"), std::string::npos);
  EXPECT_NE(preflight->get_header_value("Access-Control-Allow-Headers").find("Authorization"),
            std::string::npos);
}

TEST(Cors, RejectsWritesFromOtherOrigins) {
  Daemon daemon({"--cors-origins", "https://a.example"});
  const auto post = [&](const std::string& origin) {
    return daemon.client().Post("/v1/scenes", {{"Origin", origin}}, small_scene().dump(), "text/plain");
  };
  for (const char* origin : {"https://evil.example", "null", "http://127.0.0.1:1", "127.0.0.1"})
    expect_problem(post(origin), 403);
  EXPECT_EQ(post("http://127.0.0.1:" + std::to_string(daemon.port()))->status, 201);
  EXPECT_EQ(post("https://a.example")->status, 200);
}

// An attacker's domain can resolve to this machine (DNS rebinding), which makes its pages same-origin.
TEST(Cors, RejectsWritesThroughUnknownDomains) {
  const auto post = [](Daemon& daemon, const std::string& host) {
    const std::string here = host + ":" + std::to_string(daemon.port());
    return daemon.client().Post("/v1/scenes", {{"Host", here}, {"Origin", "http://" + here}},
                                small_scene().dump(), "application/json");
  };
  Daemon daemon, listed({"--insecure", "--cors-origins", "http://proxy.example"});
  for (const char* host : {"evil.example", "127.0.0.1.evil.example", "localhost.evil", "1270001"})
    expect_problem(post(daemon, host), 403);
  for (const char* host : {"localhost", "LOCALHOST", "127.0.0.1", "[::1]"})
    EXPECT_LE(post(daemon, host)->status, 201) << host;
  expect_problem(post(listed, "proxy.example"), 403);  // the port is part of the origin
  EXPECT_EQ(listed.client()
                .Post("/v1/scenes", {{"Host", "proxy.example"}, {"Origin", "http://proxy.example"}},
                      small_scene().dump(), "application/json")
                ->status,
            201);
}

TEST(Cors, RejectsReadsThroughUnknownDomains) {
  Daemon daemon({"--cors-origins", "http://render.example:8080"});
  auto client = daemon.client();
  const auto status = [&](const char* path, const char* host) {
    return client.Get(path, {{"Host", host}})->status;
  };
  for (const char* host : {"127.0.0.1", "[::1]:80", "localhost:8080", "orrery:8080", "render.example:8080"})
    EXPECT_EQ(status("/v1/limits", host), 200) << host;
  for (const char* host : {"evil.example", "evil.example:8080", "127.0.0.1.evil.example"})
    EXPECT_EQ(status("/v1/limits", host), 403) << host;
  EXPECT_EQ(status("/", "evil.example"), 200) << "the page is not confidential";
  TokenDaemon guarded;
  httplib::Headers headers = bearer("r");
  headers.emplace("Host", "render.example");
  EXPECT_EQ(guarded.client.Get("/v1/limits", headers)->status, 200);
}

TEST(Cors, IsDisabledByDefault) {
  Daemon daemon;
  const auto result = daemon.client().Get("/v1/limits", {{"Origin", "https://a.example"}});
  EXPECT_FALSE(result->has_header("Access-Control-Allow-Origin"));
  EXPECT_EQ(result->get_header_value("Vary"), "Accept-Encoding");
}

}  // namespace
}  // namespace orrery
