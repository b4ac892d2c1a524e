// Tests error budgets and time budgets over HTTP.
#include <cstdlib>

#include "tests/http/daemon.h"
#include "tests/support/covers.h"
#include "tests/support/eventually.h"

namespace orrery {
namespace {

class PictureBudget : public HttpTest {
 protected:
  std::string path(const std::string& query) {
    return "/v1/scenes/" + post_scene(small_scene().dump()) + "/frame.png?" + query;
  }
  httplib::Result get(const std::string& query) { return client_.Get(path(query)); }
};

bool has(const httplib::Result& result, const char* header, const char* text) {
  return result->get_header_value(header).find(text) != std::string::npos;
}

TEST_F(PictureBudget, ReturnsCacheableImageForErrorBudget) {
  const auto first = get("error=0.2");
  ASSERT_EQ(first->status, 200) << first->body.substr(0, 400);
  EXPECT_TRUE(has(first, "Orrery-Budget", "met=?1;error=0.2;error-met=?1"));
  EXPECT_TRUE(has(first, "Orrery-Error-Bound", "space=display"));
  EXPECT_EQ(first->get_header_value("Cache-Control"), "public, max-age=31536000, immutable");
  const std::string etag = first->get_header_value("ETag");
  EXPECT_FALSE(etag.empty());
  EXPECT_EQ(get_known(path("error=0.2"), etag)->status, 304);
  EXPECT_TRUE(get("error=0.2&seed=1")->body != first->body);
}

// Radiance of paths has no upper limit, so the bound is estimated, and the response says so.
TEST_F(PictureBudget, ReportsKindOfEstimatedBound) {
  const auto made = get("error=0.2&technique=path&error_metric=linear&width=96&height=96");
  ASSERT_EQ(made->status, 200) << made->body.substr(0, 400);
  EXPECT_TRUE(has(made, "Orrery-Budget", "met=?1;error=0.2;error-met=?1;kind=estimated"))
      << made->get_header_value("Orrery-Budget");
  EXPECT_TRUE(has(made, "Orrery-Error-Bound", ";kind=estimated;max=unknown;confidence=0.95;estimate="))
      << made->get_header_value("Orrery-Error-Bound");
  EXPECT_TRUE(has(made, "Orrery-Error-Bound", "space=linear"));
}

TEST_F(PictureBudget, ReproducesImageFromContentLocation) {
  for (const char* query : {"error=0.2", "seconds=0.2", "seconds=0.05&technique=path", "error=0.5&depth=2",
                            "error=0.3&pan=0.1,0,0&azimuth=20"}) {
    const auto made = get(query);
    ASSERT_EQ(made->status, 200) << query << made->body.substr(0, 400);
    const std::string plain = made->get_header_value("Content-Location");
    EXPECT_EQ(plain.find("seconds"), std::string::npos) << plain;
    EXPECT_EQ(plain.find("error"), std::string::npos) << plain;
    const auto again = client_.Get(plain);
    ASSERT_TRUE(again) << plain;
    EXPECT_TRUE(again->body == made->body) << query << " " << plain;
    EXPECT_TRUE(again->get_header_value("Orrery-Budget").empty());
  }
}

// Another daemon with a different number of threads reproduces the image.
TEST_F(PictureBudget, ReproducesImageOnAnotherDaemon) {
  test::covers("certificate-31 certificate-32");
  Daemon other({"--threads", "3"});
  httplib::Client there = other.client();
  const std::string scene = path("");
  ASSERT_EQ(there.Post("/v1/scenes", small_scene().dump(), "application/json")->status, 201);
  for (int seed = 0; seed < 50; ++seed) {
    const auto made = client_.Get(scene + "seconds=0.03&width=64&height=48&seed=" + std::to_string(seed));
    ASSERT_EQ(made->status, 200) << made->body.substr(0, 400);
    const std::string plain = made->get_header_value("Content-Location");
    EXPECT_TRUE(client_.Get(plain)->body == made->body) << plain;
    const auto again = there.Get(plain);
    ASSERT_EQ(again->status, 200) << plain;
    EXPECT_TRUE(again->body == made->body) << plain;
  }
  const auto here = client_.Get(scene + "error=0.1");
  const auto also = there.Get(scene + "error=0.1");
  EXPECT_TRUE(here->body == also->body);
  for (const char* header : {"ETag", "Content-Location", "Orrery-Error-Bound", "Orrery-Budget"})
    EXPECT_EQ(here->get_header_value(header), also->get_header_value(header)) << header;
}

// The request is rejected if its time ends before it gets a slot. It is always admitted if a slot is free.
TEST(TimeBudget, RejectsRequestIfServiceIsBusy) {
  test::covers("certificate-37");
  Daemon daemon(without_ray_limit({"--max-concurrent-renders", "1"}));
  httplib::Client client = daemon.client();
  const auto posted = client.Post("/v1/scenes", small_scene().dump(), "application/json");
  const std::string frame = posted->get_header_value("Location") + "/frame.png";
  const RawClient endless(daemon.port());
  EXPECT_EQ(client.Get(frame + "?seconds=0.000001")->status, 200);
  endless.send("GET " + frame + "?width=4096&height=4096&samples=4096 HTTP/1.1\r\nHost: x\r\n\r\n");
  ASSERT_TRUE(test::eventually([&] { return daemon.metric("orrery_renders_running") == 1; }));
  const auto refused = client.Get(frame + "?seconds=0.000001");
  const auto problem = expect_problem(refused, 503);
  EXPECT_FALSE(refused->get_header_value("Retry-After").empty());
  EXPECT_NE(problem["detail"].get<std::string>().find("limit 1e-6 s, time_limit_seconds"), std::string::npos)
      << problem;
}

TEST_F(PictureBudget, DoesNotCacheTimeBudget) {
  const auto first = get("seconds=0.2");
  EXPECT_EQ(first->get_header_value("Cache-Control"), "no-store");
  EXPECT_TRUE(first->get_header_value("ETag").empty());
  EXPECT_TRUE(has(first, "Orrery-Budget", "seconds=0.2;seconds-met=?"));
  EXPECT_FALSE(get("seconds=0.2")->get_header_value("Orrery-Rays").empty()) << "rendered again";
}

TEST_F(PictureBudget, ReportsMissedBudgetOrFails) {
  const auto best = get("error=0.001&seconds=0.3");
  ASSERT_EQ(best->status, 200);
  EXPECT_TRUE(has(best, "Orrery-Budget", "met=?0;error=0.001;error-met=?0"));
  EXPECT_TRUE(has(best, "Orrery-Budget", "reason=\""));
  const auto failed = get("error=0.001&on_miss=fail");
  ASSERT_EQ(failed->status, 422);
  const auto problem = nlohmann::json::parse(failed->body);
  EXPECT_EQ(problem["type"], "urn:orrery:problem:missed-budget");
  EXPECT_EQ(problem["errors"][0]["pointer"], "/budget/max_error");
  EXPECT_GT(problem["budget"]["reachable_error"], 0.001);
  EXPECT_EQ(problem["certificate"]["space"], "display");
}

// Only a render shows that the budget is missed.
TEST_F(PictureBudget, OmitsETagForHeadIfBudgetMayFail) {
  const auto head = client_.Head(path("error=0.001&on_miss=fail"));
  EXPECT_TRUE(head->get_header_value("ETag").empty());
  EXPECT_EQ(head->get_header_value("Cache-Control"), "no-store");
  EXPECT_EQ(get_known(path("error=0.001&on_miss=fail"), "*")->status, 422);
}

TEST_F(PictureBudget, CountsEncodingInTimeBudget) {
  const auto large = get("seconds=0.02&width=1024&height=1024");
  EXPECT_TRUE(has(large, "Orrery-Budget", "met=?0;seconds=0.02;seconds-met=?0"));
}

TEST_F(PictureBudget, AcceptsBudgetInBody) {
  const auto render = [&](const nlohmann::json& budget, const char* type) {
    const nlohmann::json body = {{"scene", small_scene()}, {"budget", budget}};
    return client_.Post("/v1/render", {{"Accept", type}}, body.dump(), "application/json");
  };
  const auto png = render({{"max_error", 0.2}}, "image/png");
  ASSERT_EQ(png->status, 200) << png->body.substr(0, 400);
  EXPECT_TRUE(has(png, "Orrery-Budget", "met=?1"));
  EXPECT_TRUE(client_.Get(png->get_header_value("Content-Location"))->body == png->body);
  const auto exr = render({{"max_error", 0.2}}, "image/x-exr");
  EXPECT_TRUE(has(exr, "Orrery-Error-Bound", "space=linear"));
  EXPECT_TRUE(exr->get_header_value("Content-Location").empty()) << "only the URL of the PNG exists";
  EXPECT_TRUE(has(render({{"time_limit_seconds", 0.2}}, "image/jpeg"), "Orrery-Error-Bound", "space=linear"));
  EXPECT_EQ(render({{"max_error", -1}}, "image/png")->status, 422);
  EXPECT_EQ(render({{"second", 1}}, "image/png")->status, 422);
}

TEST_F(PictureBudget, RejectsBudgetForStreams) {
  for (const char* what : {"orbit", "refinement"}) {
    const auto result =
        client_.Get("/v1/scenes/" + post_scene(small_scene().dump()) + "/" + what + "?error=0.1");
    ASSERT_TRUE(result);
    EXPECT_EQ(result->status, 422) << what;
    EXPECT_NE(result->body.find("/budget/max_error"), std::string::npos);
  }
}

}  // namespace
}  // namespace orrery
