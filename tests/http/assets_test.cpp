#include <fstream>
#include <iterator>

#include "core/base/hash.h"
#include "tests/http/daemon.h"

namespace orrery {
namespace {

const std::string kTetrahedron =
    "v 1 1 1\nv -1 -1 1\nv -1 1 -1\nv 1 -1 -1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

class Assets : public HttpTest {
 protected:
  static std::string path_of(const std::string& bytes) { return "/v1/assets/" + sha256_hex(bytes); }
  httplib::Result put(const std::string& path, const std::string& bytes) {
    return client_.Put(path, bytes, "application/octet-stream");
  }
};

TEST_F(Assets, StoresAndReturnsMesh) {
  const std::string path = path_of(kTetrahedron);
  const auto first = put(path, kTetrahedron), second = put(path, kTetrahedron);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->status, 201);
  EXPECT_EQ(second->status, 200);
  EXPECT_EQ(first->body, second->body);
  EXPECT_EQ(first->get_header_value("Location"), path);
  const auto told = nlohmann::json::parse(first->body);
  EXPECT_EQ(told.at("format"), "obj");
  EXPECT_EQ(told.at("triangles"), 4);
  EXPECT_EQ(told.at("vertices"), 4);
  EXPECT_EQ(told.at("notes"), nlohmann::json::array());
  EXPECT_EQ(told.at("bytes"), kTetrahedron.size());
  const auto got = client_.Get(path);
  ASSERT_TRUE(got && got->status == 200);
  EXPECT_EQ(got->body, kTetrahedron);
  EXPECT_EQ(get_known(path, got->get_header_value("ETag"))->status, 304);
  EXPECT_EQ(client_.Delete(path)->status, 204);
  expect_problem(client_.Get(path), 404);
  expect_problem(client_.Delete(path), 404);
}

TEST_F(Assets, RendersSceneWithMeshAsset) {
  const std::string hash = sha256_hex(kTetrahedron);
  const auto scene = small_scene({{"title", "a mesh"},
                                  {"objects", {{{"type", "mesh"}, {"asset", hash}, {"material", "ball"}}}},
                                  {"materials", {{"ball", {{"type", "rough"}}}}}});
  client_.Delete("/v1/assets/" + hash);
  const auto missing = expect_problem(client_.Post("/v1/render", scene.dump(), "application/json"), 422);
  EXPECT_EQ(missing.at("errors").at(0).at("pointer"), "/objects/0/asset");
  EXPECT_EQ(put("/v1/assets/" + hash, kTetrahedron)->status, 201);
  const auto rendered = client_.Post("/v1/render", scene.dump(), "application/json");
  ASSERT_TRUE(rendered && rendered->status == 200) << rendered->body;
  EXPECT_TRUE(is_png(rendered->body));
  const std::string id = post_scene(scene.dump());
  EXPECT_EQ(client_.Delete("/v1/assets/" + hash)->status, 204);
  EXPECT_EQ(client_.Get("/v1/scenes/" + id + "/frame.png?azimuth=20")->status, 200)
      << "the scene keeps the mesh";
}

TEST_F(Assets, StoresImageAndLightsScene) {
  std::ifstream file("scenes/image-sky/sky.hdr", std::ios::binary);
  const std::string sky((std::istreambuf_iterator<char>(file)), {}), path = path_of(sky);
  auto scene = small_scene(
      {{"title", "under a picture"}, {"environment", {{"type", "image"}, {"asset", sha256_hex(sky)}}}});
  scene.erase("background");
  client_.Delete(path);
  const auto missing = expect_problem(client_.Post("/v1/render", scene.dump(), "application/json"), 422);
  EXPECT_EQ(missing.at("errors").at(0).at("pointer"), "/environment/asset");
  const auto kept = put(path, sky);
  ASSERT_TRUE(kept && kept->status == 201) << kept->body;
  const auto told = nlohmann::json::parse(kept->body);
  EXPECT_EQ(told.at("format"), "hdr");
  EXPECT_EQ(told.at("width"), 128);
  EXPECT_EQ(told.at("height"), 64);
  EXPECT_EQ(client_.Get(path)->get_header_value("Content-Type"), "image/vnd.radiance");
  const auto rendered = client_.Post("/v1/render", scene.dump(), "application/json");
  ASSERT_TRUE(rendered && rendered->status == 200) << rendered->body;
  const std::string half = sky.substr(0, sky.size() / 2);
  expect_problem(put(path_of(half), half), 422);
}

TEST_F(Assets, DoesNotReloadAssetsOfRenderedScene) {
  const std::string hash = sha256_hex(kTetrahedron);
  const auto scene = small_scene({{"title", "rendered, not kept"},
                                  {"objects", {{{"type", "mesh"}, {"asset", hash}, {"material", "ball"}}}},
                                  {"materials", {{"ball", {{"type", "rough"}}}}}});
  put("/v1/assets/" + hash, kTetrahedron);
  const auto render = [&](int azimuth) {
    const nlohmann::json order = {{"scene", scene}, {"camera", {{"azimuth_degrees", azimuth}}}};
    return client_.Post("/v1/render", order.dump(2), "application/json");
  };
  EXPECT_EQ(render(10)->status, 200);
  EXPECT_EQ(client_.Delete("/v1/assets/" + hash)->status, 204);
  EXPECT_EQ(render(20)->status, 200) << "no asset is loaded again";
  EXPECT_EQ(client_.Post("/v1/scenes", scene.dump(), "application/json")->status, 201);
  EXPECT_EQ(client_.Post("/v1/scenes", scene.dump(), "application/json")->status, 200);
}

TEST_F(Assets, RejectsInvalidMeshesAndWrongHashes) {
  expect_problem(put(path_of("something else"), kTetrahedron), 422);
  expect_problem(put("/v1/assets/short", kTetrahedron), 422);
  expect_problem(put("/v1/assets/" + std::string(64, 'G'), kTetrahedron), 422);
  for (const std::string bad :
       {"", "no mesh at all", "v 1 2\nf 1 1 1\n", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"})
    expect_problem(put(path_of(bad), bad), 422);
  const auto packed = client_.Put(path_of(kTetrahedron), {{"Content-Encoding", "gzip"}}, kTetrahedron,
                                  "application/octet-stream");
  expect_problem(packed, 415);
  expect_problem(client_.Post(path_of(kTetrahedron), kTetrahedron, "application/octet-stream"), 405);
}

TEST_F(Assets, ReportsInvalidHash) {
  const auto scene = small_scene({{"objects", {{{"type", "mesh"}, {"asset", "abc"}, {"material", "ball"}}}},
                                  {"materials", {{"ball", {{"type", "rough"}}}}}});
  const auto problem = expect_problem(client_.Post("/v1/render", scene.dump(), "application/json"), 422);
  EXPECT_NE(problem.at("detail").get<std::string>().find("64 digits"), std::string::npos) << problem;
}

// explain may build structures, so it has the time limit and priority of a render.
TEST(Explain, RespectsRequestTimeout) {
  Daemon daemon({"--request-seconds", "1"});
  httplib::Client client = daemon.client();
  client.set_read_timeout(std::chrono::seconds(600));
  nlohmann::json glass = {{"glass", {{"type", "refractive"}, {"ior", 1.5}}}}, balls = nlohmann::json::array();
  for (int i = 0; i < 20; ++i)
    balls.push_back(
        {{"type", "sphere"}, {"center", {0, 0, 0}}, {"radius", 1 + 0.02 * i}, {"material", "glass"}});
  const auto scene = small_scene({{"materials", glass}, {"objects", balls}, {"render", {{"max_depth", 32}}}});
  const auto posted = client.Post("/v1/scenes", scene.dump(), "application/json");
  ASSERT_TRUE(posted && posted->status == 201) << posted->body;
  const auto told = client.Get(posted->get_header_value("Location") + "/explain");
  ASSERT_TRUE(told);
  EXPECT_TRUE(told->status == 200 || told->status == 504) << told->body;
}

TEST_F(Assets, RejectsFileReferencesInRequests) {
  const auto scene =
      small_scene({{"objects", {{{"type", "mesh"}, {"file", "/etc/passwd"}, {"material", "ball"}}}},
                   {"materials", {{"ball", {{"type", "rough"}}}}}});
  const auto problem = expect_problem(client_.Post("/v1/render", scene.dump(), "application/json"), 422);
  EXPECT_EQ(problem.at("errors").at(0).at("pointer"), "/objects/0/file");
}

TEST_F(Assets, AllowsRemovalByUploadersOnly) {
  const std::string path = path_of(kTetrahedron);
  httplib::Client other = daemon().client_at(2), third = daemon().client_at(3);
  const auto put = [&](httplib::Client& client) {
    return client.Put(path, kTetrahedron, "application/octet-stream")->status;
  };
  EXPECT_EQ(put(client_), 201);
  expect_problem(other.Delete(path), 403);
  EXPECT_EQ(put(other), 200);
  EXPECT_EQ(client_.Delete(path)->status, 204);
  EXPECT_EQ(client_.Get(path)->status, 200) << "the other client keeps the asset";
  expect_problem(client_.Delete(path), 403);
  expect_problem(third.Delete(path), 403);
  EXPECT_EQ(other.Delete(path)->status, 204);
  expect_problem(client_.Get(path), 404);
}

TEST(AssetLimits, KeepsAssetsOfOtherClientsDuringFlood) {
  Daemon daemon({"--asset-store-bytes", "100000"});
  httplib::Client client = daemon.client(), flood = daemon.client_at(2);
  const std::string path = "/v1/assets/" + sha256_hex(kTetrahedron);
  const auto put = [](httplib::Client& by, const std::string& bytes) {
    return by.Put("/v1/assets/" + sha256_hex(bytes), bytes, "application/octet-stream");
  };
  EXPECT_EQ(put(client, kTetrahedron)->status, 201);
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(put(flood, kTetrahedron + "#" + std::string(30'000, static_cast<char>('a' + i)) + "\n")->status,
              201);
  EXPECT_EQ(client.Get(path)->status, 200);
  EXPECT_GT(daemon.metric("orrery_evictions_total{store=\"assets\"}"), 10);
  const auto refused = expect_problem(put(flood, kTetrahedron + "#" + std::string(98'000, 'z') + "\n"), 503);
  EXPECT_NE(refused.at("detail").get<std::string>().find("asset_store_bytes"), std::string::npos) << refused;
  EXPECT_EQ(client.Get(path)->status, 200);
}

TEST(AssetLimits, EnforcesAndReportsLimits) {
  Daemon daemon({"--asset-bytes", "200", "--asset-store-bytes", "4800"});
  httplib::Client client = daemon.client();
  const auto put = [&](const std::string& bytes) {
    return client.Put("/v1/assets/" + sha256_hex(bytes), bytes, "application/octet-stream");
  };
  const std::string large = kTetrahedron + "#" + std::string(200, 'x') + "\n";
  const auto refused = expect_problem(put(large), 413);
  EXPECT_NE(refused.at("detail").get<std::string>().find("asset_bytes"), std::string::npos);
  std::vector<std::string> meshes;  // the store has capacity for four
  for (int i = 0; i < 5; ++i) meshes.push_back(kTetrahedron + "# " + std::to_string(i) + "\n");
  const std::size_t held = 4800 / (meshes[0].size() + 1024);  // with overhead per entry
  for (const auto& mesh : meshes) EXPECT_EQ(put(mesh)->status, 201);
  for (std::size_t i = 0; i < meshes.size(); ++i)
    EXPECT_EQ(client.Get("/v1/assets/" + sha256_hex(meshes[i]))->status,
              i + held < meshes.size() ? 404 : 200);
}

}  // namespace
}  // namespace orrery
