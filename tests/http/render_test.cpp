#include <atomic>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <thread>

#include "core/base/shorten.h"
#include "tests/http/daemon.h"
#include "tests/support/eventually.h"

namespace orrery {
namespace {

class Render : public HttpTest {
 protected:
  httplib::Result render(const nlohmann::json& body, const httplib::Headers& headers = {}) {
    return client_.Post("/v1/render", headers, body.dump(), "application/json");
  }
};

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST_F(Render, ReturnsImageOfPostedScene) {
  const auto result = render(small_scene());
  ASSERT_TRUE(result);
  ASSERT_EQ(result->status, 200) << result->body;
  EXPECT_EQ(result->get_header_value("Content-Type"), "image/png");
  EXPECT_TRUE(is_png(result->body));
  EXPECT_GE(std::stoull(result->get_header_value("Orrery-Rays")), 48u * 32u);
  const std::string timing = result->get_header_value("Server-Timing");
  for (const char* step : {"load;dur=", "plan;dur=", "build;dur=", "render;dur=", "encode;dur="})
    EXPECT_NE(timing.find(step), std::string::npos) << timing;
}

TEST_F(Render, MatchesCommandLineOutput) {
  const auto folder = std::filesystem::temp_directory_path() / ("orrery-render-" + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  const auto scene = folder / "scene.json", picture = folder / "picture.png";
  std::ofstream(scene) << small_scene();
  const std::string command = program() + " render " + scene.string() + " -o " + picture.string() +
                              " --azimuth 40 --samples 4 --width 100";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const auto result = render({{"scene", small_scene()},
                              {"camera", {{"azimuth_degrees", 40}}},
                              {"image", {{"width", 100}}},
                              {"render", {{"samples", 4}}}});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->body, bytes_of(picture));
  std::filesystem::remove_all(folder);
}

TEST_F(Render, ReadsFormBodyAsJson) {  // the default type of `curl --data-binary`
  std::string scene = small_scene().dump();
  scene.resize(20'000, ' ');  // longer than the limit of httplib for forms
  const auto result = client_.Post("/v1/render", scene, "application/x-www-form-urlencoded");
  ASSERT_TRUE(result);
  EXPECT_EQ(result->status, 200) << result->body;
}

TEST_F(Render, SelectsFormatByAccept) {
  const auto type_for = [&](const char* accept) {
    const auto result = render(small_scene(), {{"Accept", accept}});
    EXPECT_EQ(result->status, 200);
    const std::string type = result->get_header_value("Content-Type");
    const std::string begin = type == "image/png"    ? "\x89PNG"
                              : type == "image/jpeg" ? "\xff\xd8\xff"
                                                     : "\x76\x2f\x31\x01";
    EXPECT_TRUE(result->body.starts_with(begin)) << type;
    return type;
  };
  EXPECT_EQ(type_for("image/jpeg"), "image/jpeg");
  EXPECT_EQ(type_for("image/x-exr"), "image/x-exr");
  EXPECT_EQ(type_for("image/*"), "image/png");
  EXPECT_EQ(type_for("image/png;q=0.1, image/jpeg;q=0.9"), "image/jpeg");
  EXPECT_EQ(type_for("text/html, */*;q=0.5"), "image/png");
  EXPECT_EQ(type_for("image/png;q=0, image/*"), "image/jpeg");
  EXPECT_EQ(type_for("image/png;Q=0, image/*"), "image/jpeg");
  expect_problem(render(small_scene(), {{"Accept", "text/html"}}), 406);
  const auto two_lines = render(small_scene(), {{"Accept", "text/html"}, {"Accept", "image/jpeg"}});
  EXPECT_EQ(two_lines->get_header_value("Content-Type"), "image/jpeg");
}

// Response bodies in each format from a daemon with these settings, and the rays traced for each.
struct Formats {
  std::vector<std::string> bodies;
  std::vector<double> rays;

  explicit Formats(const std::vector<std::string>& settings) {
    const Daemon daemon(settings);
    auto client = daemon.client();
    for (const char* type : {"image/png", "image/x-exr", "image/jpeg"}) {
      const double before = daemon.metric("orrery_rays_total");
      const auto result =
          client.Post("/v1/render", {{"Accept", type}}, small_scene().dump(), "application/json");
      EXPECT_EQ(result->status, 200) << result->body;
      bodies.push_back(result->body);
      rays.push_back(daemon.metric("orrery_rays_total") - before);
      EXPECT_EQ(result->has_header("Orrery-Rays"), rays.back() > 0);
    }
  }
};

TEST_F(Render, ReusesCachedFilmForAllFormats) {
  const Formats once({}), each({"--film-cache-bytes", "0"});
  EXPECT_GT(once.rays[0], 48 * 32);
  EXPECT_EQ(once.rays, (std::vector{once.rays[0], 0.0, 0.0}));
  EXPECT_EQ(each.rays, (std::vector{once.rays[0], once.rays[0], once.rays[0]}));
  EXPECT_EQ(once.bodies, each.bodies);
}

TEST_F(Render, LimitsLayerBytes) {
  const Daemon daemon({"--memory-bytes", "160000000"});
  httplib::Client client = daemon.client();
  const auto limits = nlohmann::json::parse(client.Get("/v1/limits")->body);
  const std::size_t most = limits.at("work_bytes").get<std::size_t>() / 2;
  // Radiance, depth and normal have 7 planes, and depth and normal one weight each, for 9 planes of 8 bytes
  // per pixel.
  constexpr std::size_t kPixel = 72, kHeight = 100, kRow = kPixel * kHeight;
  const auto answer = [&](std::size_t width, const char* type) {
    const nlohmann::json body = {{"scene", small_scene()},
                                 {"image", {{"width", width}, {"height", kHeight}}},
                                 {"render", {{"layers", {"depth", "normal"}}}}};
    return client.Post("/v1/render", {{"Accept", type}}, body.dump(), "application/json");
  };
  EXPECT_EQ(answer(most / kRow / 2, "image/x-exr")->status, 200);
  const std::size_t wide = most / kRow + 1;
  const auto problem = expect_problem(answer(wide, "image/x-exr"), 422);
  EXPECT_EQ(problem.at("errors")[0].at("pointer"), "/render/layers");
  const std::string detail = problem.at("errors")[0].at("detail");
  for (const std::string& told : {grouped(wide * kRow), grouped(most), std::string("work_bytes")})
    EXPECT_NE(detail.find(told), std::string::npos) << detail;
  EXPECT_EQ(expect_problem(answer(wide, "image/png"), 422).at("errors")[0].at("pointer"), "/render/layers");
}

TEST_F(Render, OmitsSceneLayersFromFormatsWithoutLayers) {
  nlohmann::json with_layers = small_scene();
  with_layers["render"]["layers"] = {"depth"};
  const auto result = render(with_layers);
  EXPECT_EQ(result->status, 200) << result->body;
  EXPECT_EQ(result->body, render(small_scene())->body);
}

TEST_F(Render, WarnsAboutUselessImages) {
  const auto warning = [&](const nlohmann::json& scene) {
    for (int i = 0; i < 2; ++i) render(scene);  // the second response is from the cache
    return render(scene)->get_header_value("Orrery-Warning");
  };
  EXPECT_EQ(warning(small_scene()), "");
  auto scene = small_scene({{"lights", nlohmann::json::array()}, {"ambient", {0, 0, 0}}});
  scene["objects"].erase(1);  // the mirror, which reflects the background
  scene["camera"]["look_at"] = {1000, 1, 4};
  const std::string told = warning(scene);
  EXPECT_NE(told.find("/lights: "), std::string::npos) << told;
  EXPECT_NE(told.find("; /camera: nothing is in view"), std::string::npos) << told;
  const auto explanation =
      nlohmann::json::parse(client_.Get("/v1/scenes/" + post_scene(scene.dump()) + "/explain")->body);
  ASSERT_EQ(explanation.at("warnings").size(), 2u) << explanation.at("warnings");
  EXPECT_EQ(explanation.at("warnings")[0].at("pointer"), "/lights");
}

TEST_F(Render, RendersStoredSceneById) {
  const auto inline_scene = render(small_scene());
  const auto stored = render({{"scene_id", post_scene(small_scene().dump())}});
  ASSERT_TRUE(inline_scene && stored);
  EXPECT_EQ(stored->status, 200);
  EXPECT_EQ(stored->body, inline_scene->body);
  expect_problem(render({{"scene_id", std::string(64, '0')}}), 404);
}

TEST_F(Render, ReturnsIdOfRenderedScene) {
  const auto scene = small_scene({{"title", "found again"}});
  const auto rendered = render(scene);
  ASSERT_TRUE(rendered && rendered->status == 200);
  const std::string id = rendered->get_header_value("Orrery-Scene-Id");
  const std::string path = "/v1/scenes/" + id;
  EXPECT_EQ(nlohmann::json::parse(client_.Get(path)->body), scene);
  EXPECT_EQ(client_.Get(path + "/frame.png")->body, rendered->body);
  EXPECT_EQ(render({{"scene_id", id}})->get_header_value("Orrery-Scene-Id"), id);
  const auto kept = client_.Post("/v1/scenes", scene.dump(), "application/json");
  EXPECT_EQ(kept->status, 201) << "the scene is now kept";
  EXPECT_EQ(nlohmann::json::parse(kept->body).at("id"), id);
  EXPECT_EQ(client_.Post("/v1/scenes", scene.dump(), "application/json")->status, 200);
  EXPECT_EQ(client_.Delete(path)->status, 204);
  expect_problem(client_.Get(path), 404);
}

TEST_F(Render, ReportsPointersFromRequestRoot) {
  auto scene = small_scene();
  scene["objects"][0]["radius"] = -1;
  const auto problem = expect_problem(render({{"scene", scene}}), 422);
  EXPECT_EQ(problem.at("errors")[0].at("pointer"), "/scene/objects/0/radius");
}

TEST_F(Render, RejectsInvalidRequestOptions) {
  const auto pointer_of = [&](const nlohmann::json& more) {
    nlohmann::json body = {{"scene", small_scene()}};
    body.update(more);
    const auto problem = expect_problem(render(body), 422);
    return problem.is_object() ? problem.at("errors")[0].value("pointer", "?") : "none";
  };
  EXPECT_EQ(pointer_of({{"image", {{"width", 4097}}}}), "/image/width");
  EXPECT_EQ(pointer_of({{"image", {{"width", 2.5}}}}), "/image/width");
  EXPECT_EQ(pointer_of({{"render", {{"samples", 0}}}}), "/render/samples");
  EXPECT_EQ(pointer_of({{"render", {{"technique", "witted"}}}}), "/render/technique");
  EXPECT_EQ(pointer_of({{"camera", {{"azimuth", 1}}}}), "/camera");
  EXPECT_EQ(pointer_of({{"camera", {{"fov_degrees", 180}}}}), "/camera/fov_degrees");
  EXPECT_EQ(pointer_of({{"scene_id", "x"}}), "/scene_id");
  EXPECT_EQ(pointer_of({{"colour", "x"}}), "");
}

TEST_F(Render, RejectsQueryOptionsInPost) {
  const auto problem =
      expect_problem(client_.Post("/v1/render?width=4", small_scene().dump(), "application/json"), 422);
  EXPECT_EQ(problem.at("errors")[0].at("pointer"), "/width");
}

constexpr const char* kJson = "application/json";

// The limit is 2 threads x 10 s x 50 million rays. The scene has two balls, one of them a mirror, so half of
// the rays continue at each of 5 levels. The other half sample one light.
TEST(RayLimit, RejectsExpensiveRendersAndSuggestsJobs) {
  Daemon daemon({"--threads", "2", "--request-seconds", "10"});
  httplib::Client client = daemon.client();
  const std::string rays = grouped(4096ULL * 4096 * 256 * (32 + 16 + 8 + 4 + 2 + 1) / 32 * 3 / 2);
  const nlohmann::json large = {{"image", {{"width", 4096}, {"height", 4096}}},
                                {"render", {{"samples", 256}}}};
  nlohmann::json body = large;
  body["scene"] = small_scene();
  const auto expect_refused = [&](const httplib::Result& result) {
    const std::string detail = expect_problem(result, 422).value("detail", "");
    for (const std::string& told :
         {rays, std::string("limit 1,000,000,000, request_rays"), std::string("/v1/jobs")})
      EXPECT_NE(detail.find(told), std::string::npos) << detail;
  };
  expect_refused(client.Post("/v1/render", body.dump(), kJson));
  const auto posted = client.Post("/v1/scenes", small_scene().dump(), kJson);
  const std::string scene = posted->get_header_value("Location");
  for (const char* address : {"/frame.png?", "/orbit?frames=2&"})
    expect_refused(client.Get(scene + address + "width=4096&height=4096&samples=256"));
  EXPECT_TRUE(test::eventually([&] {  // counted after the response
    return daemon.metric("orrery_rejected_requests_total{reason=\"request_rays\"}") == 3;
  }));
  EXPECT_EQ(daemon.metric("orrery_rays_total"), 0);
  EXPECT_EQ(nlohmann::json::parse(client.Get("/v1/limits")->body).at("request_rays"), 1'000'000'000);
  EXPECT_EQ(client.Post("/v1/jobs", body.dump(), kJson)->status, 202);
}

// A render of 48 x 32 pixels has an estimate of 4,536 rays and traces fewer, which lowers the next estimate.
TEST(RayLimit, UsesMeasuredRaysOfScene) {
  Daemon daemon({"--request-rays", "4536"});
  httplib::Client client = daemon.client();
  const auto render = [&](int width) {
    const nlohmann::json body = {{"scene", small_scene()}, {"image", {{"width", width}}}};
    return client.Post("/v1/render", body.dump(), kJson);
  };
  expect_problem(render(49), 422);
  const auto rendered = render(48);
  ASSERT_EQ(rendered->status, 200) << rendered->body;
  EXPECT_LT(std::stoi(rendered->get_header_value("Orrery-Rays")), 4536 * 48 / 49);
  EXPECT_EQ(render(49)->status, 200);
}

// The renders take about a second, without an earlier estimate for the scene.
TEST(ConcurrentRenders, CompletesAllRendersOfSample) {
  Daemon daemon;
  const auto scene = nlohmann::json::parse(daemon.client().Get("/scenes/paper.json")->body);
  std::atomic<int> answered{0};
  std::vector<std::thread> clients;
  for (int i = 0; i < 20; ++i)
    clients.emplace_back([&, i] {
      const nlohmann::json body = {{"scene", scene},
                                   {"camera", {{"azimuth_degrees", i}}},
                                   {"image", {{"width", 800}, {"height", 600}}},
                                   {"render", {{"samples", 4}}}};
      const auto result = daemon.client().Post("/v1/render", body.dump(), kJson);
      answered += result && result->status == 200;
    });
  for (std::thread& client : clients) client.join();
  EXPECT_EQ(answered, 20);
}

}  // namespace
}  // namespace orrery
