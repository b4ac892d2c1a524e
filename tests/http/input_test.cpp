#include "tests/http/daemon.h"

// Tests that invalid scenes are reported and that the daemon continues to serve.
namespace orrery {
namespace {

struct BadInput {
  const char* name;
  std::string body;
  int status;
  const char* pointer;   // location of the first error
  const char* sentence;  // part of its detail
};
void PrintTo(const BadInput& input, std::ostream* out) { *out << input.name; }

std::string scene_with(const char* pointer, const nlohmann::json& value) {
  auto scene = small_scene();
  scene[nlohmann::json::json_pointer(pointer)] = value;
  return scene.dump();
}

std::string scene_without(const char* key) {
  auto scene = small_scene();
  scene.erase(key);
  return scene.dump();
}

std::string scene_with_text(const char* pointer, const std::string& text) {
  std::string scene = scene_with(pointer, "HERE");
  return scene.replace(scene.find("\"HERE\""), 6, text);
}

constexpr const char* kDeepest = "/objects/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0";

class BadInputs : public HttpTest, public ::testing::WithParamInterface<BadInput> {};

TEST_P(BadInputs, ReportsPointerAndReason) {
  const BadInput& input = GetParam();
  for (const char* path : {"/v1/render", "/v1/scenes"}) {
    const auto problem = expect_problem(client_.Post(path, input.body, "application/json"), input.status);
    ASSERT_TRUE(problem.is_object() && problem.contains("errors")) << problem;
    const auto& error = problem["errors"][0];
    EXPECT_EQ(error.value("pointer", "?"), input.pointer) << problem;
    EXPECT_NE(error.value("detail", "").find(input.sentence), std::string::npos) << problem;
  }
  EXPECT_EQ(client_.Post("/v1/render", small_scene().dump(), "application/json")->status, 200);
}

INSTANTIATE_TEST_SUITE_P(
    Http, BadInputs,
    ::testing::Values(
        BadInput{"Nothing", "", 400, "", "line 1, column 1"},
        BadInput{"BrokenJson", "{\"version\": 1,", 400, "/version", "line 1, column 15"},
        BadInput{"TwoDocuments", "{}{}", 400, "", "column 3"},
        BadInput{"NaNInJson", scene_with_text("/objects/0/radius", "NaN"), 400, "/objects/0/radius",
                 "column"},
        BadInput{"TooDeep", "{\"objects\": " + std::string(5000, '['), 422, kDeepest, "32"},
        BadInput{"NotAnObject", "[1, 2]", 422, "", "must be an object"},
        BadInput{"DuplicateKey", "{\"version\": 1, \"version\": 1}", 422, "/version", "duplicate"},
        BadInput{"UnknownKey", scene_with("/camera/fov", 40), 422, "/camera", "did you mean \"fov_degrees\""},
        BadInput{"MissingVersion", scene_without("version"), 422, "", "missing key \"version\""},
        BadInput{"OtherVersion", scene_with("/version", 2), 422, "/version", "got 2"},
        BadInput{"HugeNumber", scene_with_text("/objects/0/radius", "1e999"), 422, "/objects/0/radius",
                 "1e999"},
        BadInput{"HugeImage", scene_with("/image/width", 100000), 422, "/image/width", "4096"},
        BadInput{"NegativeRadius", scene_with("/objects/0/radius", -1), 422, "/objects/0/radius", "got -1"},
        BadInput{"TextForNumber", scene_with("/objects/0/radius", "big"), 422, "/objects/0/radius",
                 "got \"big\""},
        BadInput{"ZeroLengthAxis",
                 scene_with("/objects/0", {{"type", "cylinder"},
                                           {"base", {0, 0, 0}},
                                           {"top", {0, 0, 0}},
                                           {"radius", 1},
                                           {"material", "plum"}}),
                 422, "/objects/0/top", "base"},
        BadInput{"ZeroNormal", scene_with("/objects/1/normal", {0, 0, 0}), 422, "/objects/1/normal",
                 "not all 0"},
        BadInput{"EmptyScene", scene_with("/objects", nlohmann::json::array()), 422, "/objects",
                 "1 to 1000000"},
        BadInput{"MissingMaterial", scene_with("/objects/0/material", "gold"), 422, "/objects/0/material",
                 "gold"},
        BadInput{"UnknownShape", scene_with("/objects/0/type", "blob"), 422, "/objects/0/type", "blob"},
        BadInput{"IntensityOverFloat", scene_with_text("/lights/0/intensity", "[1e39, 0, 0]"), 422,
                 "/lights/0/intensity/0", "1e6"},
        BadInput{"EyeAtTarget", scene_with("/camera/eye", {0, 0, 0}), 422, "/camera/look_at", "eye"}),
    [](const auto& input) { return input.param.name; });

class RequestBodies : public HttpTest {};

TEST_F(RequestBodies, RejectsBodiesOverLimit) {
  const auto problem =
      expect_problem(client_.Post("/v1/render", std::string(9 << 20, ' '), "application/json"), 413);
  EXPECT_NE(problem.value("detail", "").find("8,388,608"), std::string::npos);
  EXPECT_EQ(client_.Get("/healthz")->status, 200);
}

TEST_F(RequestBodies, AcceptsBodiesAtLimit) {
  std::string scene = small_scene().dump();
  scene.resize(8 << 20, ' ');
  EXPECT_EQ(client_.Post("/v1/render", scene, "application/json")->status, 200);
}

// Deeply nested names of control characters cause the longest possible errors, because JSON escapes each
// character with six bytes.
TEST_F(RequestBodies, LimitsErrorsTo64KiB) {
  const std::string name(1000, '\x01'), written = nlohmann::json(name).dump();
  std::string deep = "1";
  for (int i = 0; i < 30; ++i) deep = "{" + written + ":" + deep + "," + written + ":1}";
  auto wide = small_scene();
  for (int i = 0; i < 20; ++i)
    wide["materials"][name + std::to_string(i)] = {{"type", "rough"}, {"kd", name}};
  for (const std::string& body : {deep, wide.dump(), nlohmann::json(std::string(4 << 20, 'x')).dump(),
                                  "{" + nlohmann::json(std::string(4 << 20, 'x')).dump() + ": tru}"}) {
    const auto result = client_.Post("/v1/render", body, "application/json");
    ASSERT_TRUE(result);
    EXPECT_GE(result->status, 400);
    EXPECT_LE(result->body.size(), 64u * 1024);
    EXPECT_FALSE(nlohmann::json::parse(result->body).at("errors").empty());
  }
}

TEST_F(RequestBodies, RejectsUnsupportedTypes) {
  for (const char* type : {"image/png", "multipart/form-data; boundary=x", "application/xml",
                           "application/json; charset=utf-16", "text/plain;CHARSET=\"latin1\""})
    expect_problem(client_.Post("/v1/render", small_scene().dump(), type), 415);
  for (const char* type : {"application/json; charset=UTF-8", "application/json;charset=\"utf-8\""})
    EXPECT_EQ(client_.Post("/v1/render", small_scene().dump(), type)->status, 200) << type;
  const httplib::Headers compressed{{"Content-Encoding", "gzip"}};
  expect_problem(client_.Post("/v1/render", compressed, small_scene().dump(), "application/json"), 415);
}

TEST_F(RequestBodies, ReportsPositionOfSyntaxError) {
  const auto problem =
      expect_problem(client_.Post("/v1/render", "{\n  \"version\": 1,\n  !\n}", "application/json"), 400);
  EXPECT_EQ(problem.at("line"), 3);
  EXPECT_EQ(problem.at("column"), 3);
  EXPECT_EQ(problem.at("offset"), 20);
}

}  // namespace
}  // namespace orrery
