#include "server/routes/routes.h"

#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "core/base/hash.h"
#include "server/base/embedded.h"
#include "server/http/target.h"
#include "server/routes/openapi.h"
#include "tests/http/daemon.h"

// Tests the scope, log level and description of each route.
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

// Returns the names of the parameters in the path that an operation describes.
std::multiset<std::string> path_parameters(const nlohmann::json& operation) {
  std::multiset<std::string> names;
  for (const auto& parameter : operation.value("parameters", nlohmann::json::array()))
    if (parameter.value("in", "") == "path") names.insert(parameter.at("name"));
  return names;
}
std::multiset<std::string> placeholders(const std::string& path) {
  std::multiset<std::string> names;
  for (std::size_t at = 0; (at = path.find('{', at)) != std::string::npos; ++at)
    names.insert(path.substr(at + 1, path.find('}', at) - at - 1));
  return names;
}

TEST_F(Routes, DescribesEveryEndpointOnce) {
  const auto paths = nlohmann::json::parse(openapi_text(router_)).at("paths");
  std::set<std::string> page_files;
  for (const EmbeddedFile& file : embedded_files())
    if (file.path.starts_with("web/")) page_files.insert(std::string(file.path.substr(3)));
  for (const Route& route : router_.routes()) {
    const bool of_page = route.pattern == "/" || page_files.contains(route.pattern);
    EXPECT_EQ(route.operation.has_value(), !of_page) << route.pattern;
    const bool is_sample = route.pattern.starts_with("/scenes/");
    EXPECT_EQ(paths.contains(route.pattern), !of_page && !is_sample) << route.pattern;
  }
  std::set<std::string> ids;
  for (const auto& [path, methods] : paths.items())
    for (const auto& [method, operation] : methods.items()) {
      EXPECT_TRUE(ids.insert(operation.at("operationId")).second) << operation.at("operationId");
      EXPECT_EQ(path_parameters(operation), placeholders(path)) << method << " " << path;
    }
  EXPECT_GT(ids.size(), 25u);
}

std::set<std::string> statuses_of(const nlohmann::json& operation) {
  std::set<std::string> statuses;
  for (const auto& [status, response] : operation.at("responses").items()) statuses.insert(status);
  return statuses;
}

TEST_F(Routes, DerivesErrorsFromScopeBodyAndPath) {
  using Statuses = std::set<std::string>;
  const auto paths = nlohmann::json::parse(openapi_text(router_)).at("paths");
  EXPECT_EQ(statuses_of(paths.at("/healthz").at("get")), (Statuses{"200", "default"}));
  EXPECT_EQ(statuses_of(paths.at("/v1/limits").at("get")), (Statuses{"200", "304", "401", "403", "default"}));
  EXPECT_EQ(statuses_of(paths.at("/v1/jobs/{id}").at("delete")),
            (Statuses{"204", "401", "403", "404", "default"}));
  EXPECT_EQ(statuses_of(paths.at("/v1/scenes/{id}/frame.png").at("get")),
            (Statuses{"200", "304", "400", "401", "403", "404", "422", "429", "503", "504", "default"}));
  EXPECT_EQ(statuses_of(paths.at("/v1/assets/{sha256}").at("put")),
            (Statuses{"200", "201", "400", "401", "403", "408", "411", "413", "415", "422", "429", "503",
                      "504", "default"}));
}

// Calls `visit` with each value of a member "$ref".
void visit_references(const nlohmann::json& json, const std::function<void(const std::string&)>& visit) {
  if (json.is_object() && json.contains("$ref")) visit(json.at("$ref"));
  if (json.is_structured())
    for (const auto& member : json) visit_references(member, visit);
}

TEST_F(Routes, ReferencesExistingComponents) {
  const auto description = nlohmann::json::parse(openapi_text(router_));
  int found = 0;
  visit_references(description, [&](const std::string& reference) {
    if (!reference.starts_with("#")) return;
    EXPECT_TRUE(description.contains(nlohmann::json::json_pointer(reference.substr(1)))) << reference;
    ++found;
  });
  EXPECT_GT(found, 100);
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
  if (route.pattern == "/v1/assets/{sha256}" || route.pattern == "/v1/view") {
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
