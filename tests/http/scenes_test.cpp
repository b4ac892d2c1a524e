#include "tests/http/daemon.h"

namespace orrery {
namespace {

class Scenes : public HttpTest {};

TEST_F(Scenes, SummarisesPostedScene) {
  const auto result =
      client_.Post("/v1/scenes", small_scene({{"title", "summarised"}}).dump(), "application/json");
  ASSERT_TRUE(result);
  EXPECT_EQ(result->status, 201);
  const auto summary = nlohmann::json::parse(result->body);
  const std::string id = summary.at("id");
  EXPECT_EQ(id.size(), 64u);
  EXPECT_EQ(summary.at("width"), 48);
  EXPECT_EQ(summary.at("height"), 32);
  EXPECT_EQ(summary.at("objects"), 2);
  EXPECT_EQ(summary.at("lights"), 1);
  EXPECT_EQ(summary.at("camera").at("up"), nlohmann::json({0.0, 1.0, 0.0}));
  EXPECT_EQ(summary.at("camera").at("fov_degrees"), 45.0);
  EXPECT_EQ(result->get_header_value("Location"), "/v1/scenes/" + id);
  EXPECT_EQ(result->get_header_value("ETag"), "\"" + id + "\"");
}

TEST_F(Scenes, RecognisesSceneInAnotherLayout) {
  const auto scene = small_scene({{"title", "layout"}});
  const auto first = client_.Post("/v1/scenes", scene.dump(), "application/json");
  const auto second = client_.Post("/v1/scenes", scene.dump(4), "application/json");
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->status, 201);
  EXPECT_EQ(second->status, 200);
  EXPECT_EQ(first->body, second->body);
}

TEST_F(Scenes, ReturnsSceneInCanonicalForm) {
  const auto scene = small_scene({{"title", "canonical"}});
  const std::string id = post_scene(scene.dump(2));
  const auto got = client_.Get("/v1/scenes/" + id);
  ASSERT_TRUE(got && got->status == 200);
  EXPECT_EQ(nlohmann::json::parse(got->body), scene);
  EXPECT_EQ(got->body.find('\n'), std::string::npos);
  EXPECT_EQ(post_scene(got->body), id);
  const auto known = get_known("/v1/scenes/" + id, got->get_header_value("ETag"));
  EXPECT_EQ(known->status, 304);
  const auto head = client_.Head("/v1/scenes/" + id);
  EXPECT_EQ(head->status, 200);
  EXPECT_EQ(head->get_header_value("Content-Length"), std::to_string(got->body.size()));
}

TEST_F(Scenes, ReturnsNotFoundAfterDelete) {
  const std::string path = "/v1/scenes/" + post_scene(small_scene({{"title", "deleted"}}).dump());
  const auto removed = client_.Delete(path);
  ASSERT_TRUE(removed);
  EXPECT_EQ(removed->status, 204);
  EXPECT_TRUE(removed->body.empty());
  expect_problem(client_.Get(path), 404);
  expect_problem(client_.Delete(path), 404);
  expect_problem(client_.Get(path + "/frame.png"), 404);
  expect_problem(client_.Get(path + "/orbit"), 404);
  expect_problem(client_.Get(path + "/explain"), 404);
}

TEST_F(Scenes, ReturnsForecastIfMeasured) {
  const std::string path = "/v1/scenes/" + post_scene(small_scene().dump()) + "/explain?width=64&height=64";
  const auto told = [&](const std::string& query) {
    const auto result = client_.Get(path + query);
    EXPECT_TRUE(result && result->status == 200);
    return nlohmann::json::parse(result->body);
  };
  EXPECT_FALSE(told("").contains("forecast"));
  EXPECT_FALSE(told("&measure=false").contains("forecast"));
  const auto forecast = told("&measure=true&error=0.05").at("forecast");
  EXPECT_GE(forecast.at("samples"), 2);
  EXPECT_GE(forecast.at("rays"), 64 * 64 * 2);
  EXPECT_TRUE(forecast.at("budget").at("met"));
  EXPECT_LE(forecast.at("certificate").at("total").at("rms"), 0.05);
  EXPECT_FALSE(told("&measure=true").at("forecast").contains("budget"));
  const auto measured = client_.Get(path + "&measure=true");
  EXPECT_EQ(measured->get_header_value("Cache-Control"), "no-store");
  const auto refused = client_.Get(path + "&measure=maybe");
  expect_problem(refused, 422);
  EXPECT_NE(refused->body.find("/measure"), std::string::npos) << refused->body;
}

TEST_F(Scenes, ExplainsDecisionsForQuery) {
  const std::string path = "/v1/scenes/" + post_scene(small_scene().dump()) + "/explain";
  const auto result = client_.Get(path + "?technique=raycast&width=100&height=50&samples=4");
  ASSERT_TRUE(result && result->status == 200);
  const auto plan = nlohmann::json::parse(result->body);
  EXPECT_EQ(plan.at("technique"), "raycast");
  EXPECT_EQ(plan.at("camera_rays"), 100 * 50 * 4);
  ASSERT_FALSE(plan.at("decisions").empty());
  for (const auto& decision : plan.at("decisions"))
    for (const char* part : {"subject", "choice", "reason"}) EXPECT_FALSE(decision.value(part, "").empty());
}

TEST_F(Scenes, AllowsRemovalByPostersOnly) {
  const std::string scene = small_scene({{"title", "of two"}}).dump(),
                    path = "/v1/scenes/" + post_scene(scene);
  httplib::Client other = daemon().client_at(2);
  expect_problem(other.Delete(path), 403);
  EXPECT_EQ(other.Post("/v1/scenes", scene, "application/json")->status, 200);
  EXPECT_EQ(client_.Delete(path)->status, 204);
  EXPECT_EQ(client_.Get(path)->status, 200) << "the other client keeps the scene";
  EXPECT_EQ(other.Delete(path)->status, 204);
  expect_problem(client_.Get(path), 404);
}

TEST(SceneStore, EvictsLeastRecentlyUsedScenes) {
  Daemon daemon({"--scene-cache-bytes", "40000"});
  httplib::Client client = daemon.client();
  const auto post = [&](const char* title) {
    const auto result = client.Post("/v1/scenes", small_scene({{"title", title}}).dump(), "application/json");
    return std::string("/v1/scenes/") + nlohmann::json::parse(result->body).at("id").get<std::string>();
  };
  const std::string used = post("used");
  const std::string unused = post("unused");
  for (int i = 0; i < 8; ++i) {
    post(std::to_string(i).c_str());
    EXPECT_EQ(client.Get(used)->status, 200);
  }
  EXPECT_EQ(client.Get(unused)->status, 404);
}

}  // namespace
}  // namespace orrery
