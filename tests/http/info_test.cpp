#include "tests/http/daemon.h"

// What the service says about itself, and the files it carries.
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

TEST_F(Info, HealthAndReadinessAreOk) {
  EXPECT_EQ(get_json("/healthz"), nlohmann::json({{"status", "ok"}}));
  EXPECT_EQ(get_json("/readyz"), nlohmann::json({{"status", "ok"}}));
}

TEST_F(Info, CatalogNamesWhatScenesCanUse) {
  const auto catalog = get_json("/v1/catalog");
  for (const char* room : {"shapes", "materials", "lights", "cameras", "techniques", "accelerators"}) {
    ASSERT_FALSE(catalog.value(room, nlohmann::json()).empty()) << room;
    for (const auto& entry : catalog[room]) {
      EXPECT_FALSE(entry.value("type", "").empty()) << room;
      EXPECT_FALSE(entry.value("summary", "").empty()) << room;
    }
  }
}

TEST_F(Info, EverySampleOfTheCatalogIsServedAndIsAGoodScene) {
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

TEST_F(Info, LimitsArePublished) {
  const auto limits = get_json("/v1/limits");
  EXPECT_EQ(limits.at("body_bytes"), 8 << 20);
  EXPECT_EQ(limits.at("image_side"), 4096);
  EXPECT_EQ(limits.at("image_pixels"), 16777216);
  EXPECT_EQ(limits.at("samples"), 4096);
  EXPECT_EQ(limits.at("orbit_frames"), 3600);
  EXPECT_EQ(limits.at("chart_pixels"), 1048576);
}

TEST_F(Info, SchemaIsServedWithAnETag) {
  const auto schema = client_.Get("/schemas/scene.json");
  ASSERT_TRUE(schema);
  EXPECT_EQ(nlohmann::json::parse(schema->body).at("type"), "object");
  const auto again = get_known("/schemas/scene.json", schema->get_header_value("ETag"));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->status, 304);
}

TEST_F(Info, DescribesItself) {
  const auto description = client_.Get("/openapi.json");
  ASSERT_TRUE(description && description->status == 200);
  EXPECT_EQ(nlohmann::json::parse(description->body).at("openapi"), "3.1.0");
  EXPECT_EQ(get_known("/openapi.json", description->get_header_value("ETag"))->status, 304);
}

TEST_F(Info, PageIsServedWithTypesAndProtection) {
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

TEST_F(Info, PageIsNotSentAgainWhenKnown) {
  const auto page = client_.Get("/");
  ASSERT_TRUE(page);
  const auto again = get_known("/", "W/" + page->get_header_value("ETag"));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->status, 304);
  EXPECT_TRUE(again->body.empty());
}

TEST_F(Info, HeadHasTheHeadersOfGetWithoutTheBody) {
  const auto get = client_.Get("/");
  const auto head = client_.Head("/");
  ASSERT_TRUE(get && head);
  EXPECT_EQ(head->status, 200);
  EXPECT_EQ(head->get_header_value("Content-Length"), std::to_string(get->body.size()));
  EXPECT_EQ(head->get_header_value("ETag"), get->get_header_value("ETag"));
  EXPECT_TRUE(head->body.empty());
}

TEST_F(Info, UnknownPathsAreNotFound) {
  for (const char* path : {"/nosuch", "/v1", "/v1/", "/v1/scenes/x/y", "/scenes/nosuch.json", "/../core",
                           "//", "/web/index.html", "/%2e%2e/etc/passwd"})
    expect_problem(client_.Get(path), 404);
}

TEST_F(Info, WrongMethodsAreToldWhichAreRight) {
  const auto remove = client_.Delete("/v1/render");
  expect_problem(remove, 405);
  EXPECT_EQ(remove->get_header_value("Allow"), "OPTIONS, POST");
  const auto put = client_.Put("/v1/scenes/abc", "{}", "application/json");
  expect_problem(put, 405);
  EXPECT_EQ(put->get_header_value("Allow"), "DELETE, GET, HEAD, OPTIONS");
}

TEST_F(Info, RequestIdIsEchoedIfItIsCleanAndMadeIfNot) {
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
