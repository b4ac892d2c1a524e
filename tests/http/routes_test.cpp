#include "server/routes/routes.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "core/base/hash.h"
#include "server/base/embedded.h"
#include "server/http/target.h"
#include "tests/http/daemon.h"

// Tests the scope and log level of each route.
namespace orrery {
namespace {

Request request_for(const std::string& method, const std::string& path) {
  Request request;
  request.method = method;
  Target target = parse_target(path);
  request.path = std::move(target.path);
  request.segments = std::move(target.segments);
  return request;
}

class Routes : public ::testing::Test {
 protected:
  Routes() {
    add_routes(router_, app_);
    add_health_routes(health_, app_);
  }
  const Route& find(const std::string& method, const std::string& path) const {
    Request request = request_for(method, path);
    return router_.find(request);
  }

  SteadyTimer timer_;
  App app_{Settings(), timer_};
  Router router_, health_;
};

struct RouteScope {
  const char *method, *path;
  Scope scope;
};

TEST_F(Routes, RequiresExpectedScopes) {
  for (const auto& [method, path, scope] : {
           RouteScope{"POST", "/v1/render", Scope::render},
           RouteScope{"POST", "/v1/jobs", Scope::render},
           RouteScope{"DELETE", "/v1/jobs/a", Scope::render},
           RouteScope{"POST", "/v1/scenes/a/charts", Scope::render},
           RouteScope{"POST", "/v1/scenes", Scope::write},
           RouteScope{"DELETE", "/v1/scenes/a", Scope::write},
           RouteScope{"PUT", "/v1/assets/a", Scope::write},
           RouteScope{"DELETE", "/v1/assets/a", Scope::write},
           RouteScope{"POST", "/v1/shares", Scope::read | Scope::write},
       })
    EXPECT_EQ(find(method, path).scope, scope) << method << " " << path;
  for (const char* path :
       {"/v1/scenes/a", "/v1/scenes/a/frame.png", "/v1/scenes/a/orbit", "/v1/scenes/a/refinement",
        "/v1/scenes/a/explain", "/v1/scenes/a/charts/b.svg", "/v1/jobs/a", "/v1/jobs/a/events",
        "/v1/jobs/a/frames/0.png", "/v1/assets/a", "/v1/catalog", "/v1/limits", "/v1/stability"})
    for (const char* method : {"GET", "HEAD"}) EXPECT_EQ(find(method, path).scope, Scope::read) << path;
  for (const char* path :
       {"/", "/app.js", "/scenes/paper.json", "/openapi.json", "/schemas/scene.json", "/healthz", "/readyz"})
    EXPECT_EQ(find("GET", path).scope, Scope::none) << path;
}

// Returns a path of the API description with values for its placeholders.
std::string with_placeholders_filled(std::string path) {
  // Each sample scene has its own route.
  if (path.starts_with("/scenes/thumbnails/")) return "/scenes/thumbnails/paper.webp";
  if (path.starts_with("/scenes/")) return "/scenes/paper.json";
  for (std::size_t at; (at = path.find('{')) != std::string::npos;)
    path.replace(at, path.find('}') - at + 1, "a");
  return path;
}

TEST_F(Routes, MatchesOpenApiDescription) {
  const auto files = embedded_files();
  const auto file = std::find_if(files.begin(), files.end(),
                                 [](const auto& f) { return f.path == "server/routes/openapi.json"; });
  ASSERT_NE(file, files.end());
  int found = 0;
  const auto description = nlohmann::json::parse(file->bytes);
  for (const auto& [path, item] : description.at("paths").items()) {
    std::set<std::string> described{"OPTIONS"};
    for (const char* method : {"get", "post", "put", "delete"}) {
      if (!item.contains(method)) continue;
      std::string upper = method;
      for (char& c : upper) c = static_cast<char>(c - 'a' + 'A');
      described.insert(upper);
      if (upper == "GET") described.insert("HEAD");
    }
    std::string list;
    for (const std::string& method : described) list += (list.empty() ? "" : ", ") + method;
    Request request = request_for("OPTIONS", with_placeholders_filled(path));
    EXPECT_EQ(router_.allowed_methods(request), list) << path;
    ++found;
  }
  EXPECT_GT(found, 15);
}

TEST_F(Routes, LogsOnlyHealthProbesAtDebugLevel) {
  for (const char* path : {"/healthz", "/readyz"}) {
    EXPECT_EQ(find("GET", path).log, LogLevel::debug);
    Request request = request_for("HEAD", path);
    EXPECT_EQ(health_.find(request).log, LogLevel::debug);
  }
  for (const char* path : {"/", "/v1/limits", "/v1/scenes/a/frame.png"})
    EXPECT_EQ(find("GET", path).log, LogLevel::info);
}

// Returns a body for the route that exceeds the memory limit of a client when parsed.
std::string hostile_body(const Route& route) {
  std::string body;
  if (route.pattern == "/v1/assets/{sha256}") {
    for (int i = 0; i < 1'200'000; ++i) body += "v 0 0 0\n";
    return body + "f 1 2 3\n";
  }
  for (int i = 0; i < 400'000; ++i) body += i == 0 ? "[[0]" : ",[0]";
  return body + "]";
}

TEST(RouteBodies, ChargesClientAccount) {
  Settings settings = settings_within(150 << 20);
  settings.connections = 8;
  SteadyTimer timer;
  App app(settings, timer);
  Router router;
  add_routes(router, app);
  RequestTrace trace;
  std::string scene;
  Body body(small_scene().dump());
  app.read(body, {"127.0.0.1", {}}, trace, [&](const Document& document, const AssetSource& assets) {
    scene = app.scenes().keep(document, assets, "127.0.0.1").scene->scene().id;
  });
  int found = 0;
  for (const Route& route : router.routes()) {
    if (!route.body) continue;
    ++found;
    const std::string bytes = hostile_body(route);
    Request request = request_for(route.method, route.pattern);
    request.client = "127.0.0.1";
    request.path_values = {{"id", scene}, {"sha256", sha256_hex(bytes)}};
    request.body = Body(bytes);
    try {
      route.handler(request);
      ADD_FAILURE() << route.pattern << " accepted the body";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("work_bytes)"), std::string::npos)
          << route.pattern << ": " << error.what();
    }
  }
  EXPECT_GE(found, 6);
}

TEST_F(Routes, ReadsBodiesOnlyWhereExpected) {
  for (const char* path : {"/v1/render", "/v1/scenes", "/v1/jobs", "/v1/scenes/a/charts", "/v1/shares"}) {
    const Route& route = find("POST", path);
    ASSERT_TRUE(route.body) << path;
    EXPECT_EQ(std::string(route.body->limit.name), "max_request_body_bytes");
    EXPECT_EQ(route.body->limit.bytes, app_.settings().max_request_body_bytes);
  }
  const Route& asset = find("PUT", "/v1/assets/a");
  ASSERT_TRUE(asset.body);
  EXPECT_EQ(std::string(asset.body->limit.name), "asset_bytes");
  EXPECT_EQ(asset.body->limit.bytes, app_.settings().asset_bytes);
  for (const char* path : {"/v1/scenes/a", "/v1/jobs/a"}) EXPECT_FALSE(find("DELETE", path).body) << path;
  EXPECT_FALSE(find("GET", "/v1/limits").body);
}

}  // namespace
}  // namespace orrery
