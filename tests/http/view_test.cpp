#include <fstream>
#include <iterator>

#include "core/base/hash.h"
#include "tests/http/daemon.h"
#include "tests/meshes/writers.h"

namespace orrery {
namespace {

using test::Gltf;

const std::string kTetrahedron =
    "v 1 1 1\nv -1 -1 1\nv -1 1 -1\nv 1 -1 -1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
const std::string kSmall = "?width=40&height=30&samples=2";

class View : public HttpTest {
 protected:
  httplib::Result post(const std::string& query, const std::string& body = kTetrahedron) {
    return client_.Post("/v1/view" + query, body, "application/octet-stream");
  }
  static std::string path(const std::string& query = kSmall) {
    return "/v1/assets/" + sha256_hex(kTetrahedron) + "/view.png" + query;
  }
};

TEST_F(View, RendersUploadedModel) {
  const auto posted = post(kSmall);
  ASSERT_TRUE(posted && posted->status == 200) << posted->body;
  EXPECT_TRUE(is_png(posted->body));
  EXPECT_EQ(posted->get_header_value("Orrery-Asset-Id"), sha256_hex(kTetrahedron));
  EXPECT_FALSE(posted->has_header("Orrery-Model-Notes"));
  EXPECT_EQ(post(kSmall, "usemtl red\n" + kTetrahedron + "l 1 2\n")->get_header_value("Orrery-Model-Notes"),
            "material \"red\" is not defined; 1 lines are not rendered");
  const auto by_url = client_.Get(path());
  ASSERT_TRUE(by_url && by_url->status == 200);
  EXPECT_EQ(by_url->body, posted->body);
  EXPECT_NE(client_.Get(path(kSmall + "&from=front"))->body, posted->body);
  const std::string scene = "/v1/scenes/" + posted->get_header_value("Orrery-Scene-Id");
  EXPECT_EQ(client_.Get(scene + "/frame.png?samples=2")->body, posted->body) << "the scene has the size";
}

// The image is that of the model outside of an archive, and up is that of its format.
TEST_F(View, RendersArchivedModel) {
  const std::string model = test::binary_stl_of(test::cube());
  const std::string archive = test::Zip().add("parts/cube.stl", model).add("readme.txt", "old").bytes();
  const auto posted = post(kSmall, archive);
  ASSERT_TRUE(posted && posted->status == 200) << posted->body;
  EXPECT_EQ(posted->body, post(kSmall, model)->body);
  const std::string asset = "/v1/assets/" + posted->get_header_value("Orrery-Asset-Id");
  EXPECT_EQ(client_.Get(asset + "/view.png" + kSmall)->body, posted->body);
  const auto got = client_.Get(asset);
  EXPECT_EQ(got->body, archive);
  EXPECT_EQ(got->get_header_value("Content-Type"), "application/zip");
  const auto put = client_.Put(asset, archive, "application/octet-stream");
  EXPECT_EQ(nlohmann::json::parse(put->body).at("format"), "stl");
  const auto refused = expect_problem(post(kSmall, test::Zip().add("readme.txt", "old").bytes()), 422);
  EXPECT_EQ(refused.at("errors").at(0).at("detail"),
            "archive must contain a model: .gltf, .glb, .obj, .ply, .stl or .3mf (got none)");
  expect_problem(post(kSmall, archive.substr(0, 100)), 422);
}

TEST_F(View, ReturnsNotModifiedForKnownImage) {
  post(kSmall);
  const auto first = client_.Get(path());
  const std::string etag = first->get_header_value("ETag");
  ASSERT_FALSE(etag.empty());
  EXPECT_EQ(first->get_header_value("Cache-Control"), "no-cache");
  EXPECT_EQ(get_known(path(), etag)->status, 304);
  EXPECT_EQ(get_known(path(kSmall + "&ground=shadow"), etag)->status, 200);
  EXPECT_EQ(client_.Head(path())->get_header_value("ETag"), etag);
}

// The triangle moves by 5 in 1 s.
TEST_F(View, PosesAnimatedModel) {
  Gltf gltf;
  gltf.positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  gltf.add<float>({0, 1}, "SCALAR", 5126);
  gltf.add<float>({0, 0, 0, 5, 0, 0}, "VEC3", 5126);
  const std::string model =
      gltf.glb(R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0},{"mesh":0}],)"
               R"("animations":[{"samplers":[{"input":1,"output":2}],)"
               R"("channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}]}])");
  const auto rest = post(kSmall, model), start = post(kSmall + "&pose_time=0", model),
             later = post(kSmall + "&pose_time=0.5&animation=0", model);
  ASSERT_EQ(rest->status, 200) << rest->body;
  ASSERT_EQ(later->status, 200) << later->body;
  EXPECT_EQ(start->body, rest->body);
  EXPECT_NE(later->body, rest->body);
  EXPECT_NE(client_.Get("/v1/scenes/" + later->get_header_value("Orrery-Scene-Id"))->body.find("pose_time"),
            std::string::npos);
}

TEST_F(View, RejectsBadRequests) {
  const auto pointer_of = [&](const httplib::Result& result) {
    return expect_problem(result, 422).at("errors").at(0).at("pointer").get<std::string>();
  };
  EXPECT_EQ(pointer_of(post("?from=sideways")), "/from");
  EXPECT_EQ(pointer_of(post("?up=w")), "/up");
  EXPECT_EQ(pointer_of(post("?samples=0")), "/samples");
  EXPECT_EQ(pointer_of(post("?pose_time=soon")), "/pose_time");
  EXPECT_EQ(pointer_of(post("?pose_time=1&animation=-1")), "/animation");
  expect_problem(post("?form=front"), 422);
  expect_problem(post("?pose_time=1"), 422);  // not a glTF file
  expect_problem(post("", "no model"), 422);
  expect_problem(client_.Get("/v1/assets/" + std::string(64, '0') + "/view.png"), 404);
  expect_problem(client_.Get("/v1/assets/abc/view.png"), 422);
  std::ifstream file("scenes/image-sky/sky.hdr", std::ios::binary);
  const std::string sky((std::istreambuf_iterator<char>(file)), {});
  expect_problem(post("", sky), 422);
}

}  // namespace
}  // namespace orrery
