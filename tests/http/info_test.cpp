#include "server/api/render_options.h"
#include "tests/http/daemon.h"

// Tests the service's description of itself, and its embedded files.
namespace orrery {
namespace {

class Info : public HttpTest {
 protected:
  nlohmann::json get_json(const char* path) {
    const auto result = client_.Get(path);
    EXPECT_TRUE(result && result->status == 200) << path;
    return result ? nlohmann::json::parse(result->body, nullptr, false) : nlohmann::json();
  }
};

TEST_F(Info, ReportsHealthAndReadiness) {
  EXPECT_EQ(get_json("/healthz"), nlohmann::json({{"status", "ok"}}));
  EXPECT_EQ(get_json("/readyz"), nlohmann::json({{"status", "ok"}}));
}

TEST_F(Info, ListsSceneTypesInCatalog) {
  const auto catalog = get_json("/v1/catalog");
  for (const char* room : {"shapes", "materials", "lights", "cameras", "techniques", "accelerators"}) {
    ASSERT_FALSE(catalog.value(room, nlohmann::json()).empty()) << room;
    for (const auto& entry : catalog[room]) {
      EXPECT_FALSE(entry.value("type", "").empty()) << room;
      EXPECT_FALSE(entry.value("summary", "").empty()) << room;
    }
  }
}

TEST_F(Info, ServesValidSceneForEverySample) {
  const auto catalog = get_json("/v1/catalog");
  ASSERT_FALSE(catalog.at("samples").empty());
  for (const auto& sample : catalog.at("samples")) {
    const std::string href = sample.at("href");
    const auto scene = client_.Get("/" + href);
    ASSERT_TRUE(scene && scene->status == 200) << href;
    EXPECT_EQ(scene->get_header_value("Content-Type"), "application/json");
    const auto posted = client_.Post("/v1/scenes", scene->body, "application/json");
    ASSERT_TRUE(posted) << href;
    EXPECT_EQ(posted->status, 201) << href << posted->body;
  }
}

TEST_F(Info, ServesThumbnailForEverySampleScene) {
  const auto catalog = get_json("/v1/catalog");
  ASSERT_FALSE(catalog.at("samples").empty());
  for (const auto& sample : catalog.at("samples")) {
    const std::string path = "/scenes/thumbnails/" + sample.at("name").get<std::string>() + ".webp";
    const auto thumbnail = client_.Get(path);
    ASSERT_TRUE(thumbnail && thumbnail->status == 200) << path;
    EXPECT_EQ(thumbnail->get_header_value("Content-Type"), "image/webp");
    EXPECT_EQ(thumbnail->body.substr(8, 4), "WEBP") << path;
    EXPECT_LT(thumbnail->body.size(), 16u << 10) << path;
  }
}

TEST_F(Info, PublishesLimits) {
  const auto limits = get_json("/v1/limits");
  EXPECT_EQ(limits.at("max_request_body_bytes"), 8 << 20);
  EXPECT_EQ(limits.at("image_side"), 4096);
  EXPECT_EQ(limits.at("image_pixels"), 16777216);
  EXPECT_EQ(limits.at("samples"), 4096);
  EXPECT_EQ(limits.at("orbit_frames"), 3600);
  EXPECT_EQ(limits.at("chart_pixels"), 1048576);
}

TEST_F(Info, ReportsStabilityWithinBounds) {
  const auto stability = get_json("/v1/stability");
  EXPECT_EQ(stability.at("holds"), true);
  EXPECT_GE(stability.at("rows").size(), 14u);
  EXPECT_EQ(get_json("/v1/stability"), stability);
}

TEST_F(Info, ServesSchemaWithETag) {
  const auto schema = client_.Get("/schemas/scene.json");
  ASSERT_TRUE(schema);
  EXPECT_EQ(nlohmann::json::parse(schema->body).at("type"), "object");
  const auto again = get_known("/schemas/scene.json", schema->get_header_value("ETag"));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->status, 304);
}

TEST_F(Info, ServesOpenApiDescription) {
  const auto description = client_.Get("/openapi.json");
  ASSERT_TRUE(description && description->status == 200);
  EXPECT_EQ(nlohmann::json::parse(description->body).at("openapi"), "3.1.0");
  EXPECT_EQ(get_known("/openapi.json", description->get_header_value("ETag"))->status, 304);
}

// Returns true if the schema limits its values by a range, an enumeration, items or the type boolean.
bool bounds_its_values(const nlohmann::json& schema) {
  const bool number = schema.contains("minimum") || schema.contains("exclusiveMinimum");
  const bool both = number && (schema.contains("maximum") || schema.contains("exclusiveMaximum"));
  return both || schema.contains("enum") || schema.contains("items") || schema.value("type", "") == "boolean";
}

TEST_F(Info, DescribesEveryRenderOption) {
  const auto description = get_json("/openapi.json");
  const auto& components = description.at("components");
  for (const std::string_view name : render_option_names()) {
    const std::string component = "query-" + std::string(name);
    const auto& parameter = components.at("parameters").at(component);
    EXPECT_EQ(parameter.at("name"), name);
    EXPECT_FALSE(parameter.at("description").get<std::string>().empty()) << name;
    EXPECT_TRUE(bounds_its_values(parameter.at("schema"))) << name;
    const nlohmann::json reference = {{"$ref", "#/components/parameters/" + component}};
    for (const char* path : {"frame.png", "orbit", "explain"}) {
      const auto& asked = description.at("paths").at("/v1/scenes/{id}/" + std::string(path)).at("get");
      EXPECT_EQ(std::count(asked.at("parameters").begin(), asked.at("parameters").end(), reference), 1)
          << name;
    }
  }
  for (const RenderOption& option : render_options()) {
    const auto& section = components.at("schemas").at(name_of(option.section)).at("properties");
    EXPECT_FALSE(section.at(option.key).at("description").get<std::string>().empty()) << option.key;
    EXPECT_TRUE(bounds_its_values(section.at(option.key))) << option.key;
  }
}

TEST_F(Info, DescribesHeadersOfImages) {
  const auto description = get_json("/openapi.json");
  const auto& headers =
      description.at("paths").at("/v1/render").at("post").at("responses").at("200").at("headers");
  const auto rendered = client_.Post("/v1/render", small_scene().dump(), "application/json");
  EXPECT_TRUE(rendered->has_header("Orrery-Error-Bound"));
  for (const auto& [name, value] : rendered->headers)
    EXPECT_TRUE(headers.contains(name) || !name.starts_with("Orrery-")) << name;
}

TEST_F(Info, PublishesLimitsAndDefaultsOfRenderOptions) {
  const auto limits = get_json("/v1/limits").at("options"), defaults = get_json("/v1/catalog").at("defaults");
  for (const RenderOption& option : render_options()) {
    EXPECT_TRUE(bounds_its_values(limits.at(option.key))) << option.key;
    EXPECT_EQ(defaults.at(option.key), nlohmann::json::parse(option.text(default_settings())));
  }
  EXPECT_EQ(limits.at("samples"), nlohmann::json({{"type", "integer"}, {"minimum", 1}, {"maximum", 4096}}));
}

TEST_F(Info, ReturnsReproducibleRequestInExplain) {
  const std::string scene = "/v1/scenes/" + post_scene(moving_scene().dump());
  const std::string query = "?azimuth=30&pan=0.1,0,0&samples=3&time=0.5&fov=50&max_depth=2&seed=7";
  const auto explained = get_json((scene + "/explain" + query).c_str());
  const auto& request = explained.at("request");
  for (const RenderOption& option : render_options())
    EXPECT_TRUE(request.at(name_of(option.section)).contains(option.key)) << option.key;
  const auto picture = client_.Get(scene + "/frame.png" + query);
  const auto rendered = client_.Post("/v1/render", request.dump(), "application/json");
  ASSERT_TRUE(picture && rendered);
  ASSERT_EQ(rendered->status, 200) << rendered->body;
  EXPECT_EQ(rendered->body, picture->body);
}

TEST_F(Info, ServesPageWithTypesAndSecurityHeaders) {
  const auto page = client_.Get("/");
  ASSERT_TRUE(page && page->status == 200);
  EXPECT_EQ(page->get_header_value("Content-Type"), "text/html; charset=utf-8");
  EXPECT_EQ(page->get_header_value("Content-Security-Policy"), "default-src 'self'");
  EXPECT_EQ(page->get_header_value("X-Content-Type-Options"), "nosniff");
  EXPECT_FALSE(page->get_header_value("Referrer-Policy").empty());
  EXPECT_FALSE(page->has_header("Content-Encoding"));
  const auto script = client_.Get("/app.js");
  ASSERT_TRUE(script && script->status == 200);
  EXPECT_EQ(script->get_header_value("Content-Type"), "text/javascript; charset=utf-8");
}

TEST_F(Info, ReturnsNotModifiedForKnownPage) {
  const auto page = client_.Get("/");
  ASSERT_TRUE(page);
  const auto again = get_known("/", "W/" + page->get_header_value("ETag"));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->status, 304);
  EXPECT_TRUE(again->body.empty());
}

TEST_F(Info, ReturnsGetHeadersForHead) {
  const auto get = client_.Get("/");
  const auto head = client_.Head("/");
  ASSERT_TRUE(get && head);
  EXPECT_EQ(head->status, 200);
  EXPECT_EQ(head->get_header_value("Content-Length"), std::to_string(get->body.size()));
  EXPECT_EQ(head->get_header_value("ETag"), get->get_header_value("ETag"));
  EXPECT_TRUE(head->body.empty());
}

TEST_F(Info, ReturnsNotFoundForUnknownPaths) {
  for (const char* path : {"/nosuch", "/v1", "/v1/", "/v1/scenes/x/y", "/scenes/nosuch.json", "/../core",
                           "//", "/web/index.html", "/%2e%2e/etc/passwd"})
    expect_problem(client_.Get(path), 404);
}

TEST_F(Info, SuggestsFullPathIfNameIsMissing) {
  const auto problem = expect_problem(client_.Post("/v1/assets", "v 0 0 0", "model/obj"), 404);
  EXPECT_NE(problem.at("detail").get<std::string>().find("PUT /v1/assets/{sha256}"), std::string::npos)
      << problem;
}

TEST_F(Info, ReportsAllowedMethods) {
  const auto remove = client_.Delete("/v1/render");
  expect_problem(remove, 405);
  EXPECT_EQ(remove->get_header_value("Allow"), "OPTIONS, POST");
  const auto put = client_.Put("/v1/scenes/abc", "{}", "application/json");
  expect_problem(put, 405);
  EXPECT_EQ(put->get_header_value("Allow"), "DELETE, GET, HEAD, OPTIONS");
}

TEST_F(Info, EchoesValidRequestIdOrGeneratesOne) {
  EXPECT_EQ(client_.Get("/healthz", {{"X-Request-ID", "job-7.a_B"}})->get_header_value("X-Request-ID"),
            "job-7.a_B");
  const std::string dirty = "a b<script>";
  const std::string made =
      client_.Get("/healthz", {{"X-Request-ID", dirty}})->get_header_value("X-Request-ID");
  EXPECT_FALSE(made.empty());
  EXPECT_NE(made, dirty);
  const std::string second =
      client_.Get("/healthz", {{"X-Request-ID", std::string(65, 'x')}})->get_header_value("X-Request-ID");
  EXPECT_LE(second.size(), 64u);
  EXPECT_NE(second, made);
}

}  // namespace
}  // namespace orrery
