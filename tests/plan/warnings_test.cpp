#include "core/plan/warnings.h"

#include <gtest/gtest.h>

#include "core/load/load.h"
#include "core/plan/plan.h"
#include "tests/support/covers.h"
#include "tests/support/pictures.h"

// Tests warnings about images that show nothing useful. Deliberate choices must not cause warnings.
namespace orrery::test {
namespace {

constexpr const char* kSun = "[{'type': 'directional', 'direction_to_light': [1, 1, 1]}]";
constexpr const char* kBall = "{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}";

Json lit(const char* objects, const Json& eye = {0, 0, 4}, const char* lights = kSun) {
  Json scene = scene_of("[" + std::string(objects) + "]");
  scene["lights"] = json(lights);
  scene["camera"]["eye"] = eye;
  scene["camera"]["look_at"] = {0, 0, 0};
  scene["ambient"] = {0.1, 0.1, 0.1};
  return scene;
}

std::string warned(const Json& scene, const RenderRequest& request = {}) {
  const auto loaded = load(scene);
  std::string places;
  for (const Problem& p : find_warnings(*loaded, make_plan(*loaded, request))) {
    places += p.pointer + " ";
    EXPECT_FALSE(p.detail.empty());
  }
  return places;
}

TEST(Warnings, IsEmptyForOrdinaryScene) { EXPECT_EQ(warned(lit(kBall)), ""); }

TEST(Warnings, IsEmptyForSampleScenes) {
  for (const std::string& name : sample_names()) EXPECT_EQ(warned(sample(name)), "") << name;
}

TEST(Warnings, ReportsUnlitScene) {
  Json scene = lit(kBall, {0, 0, 4}, "[]");
  EXPECT_EQ(warned(scene), "") << "ambient light shows the outline";
  scene["ambient"] = {0, 0, 0};
  EXPECT_EQ(warned(scene), "/lights ");
  scene["lights"] =
      json("[{'type': 'directional', 'direction_to_light': [1, 1, 1], 'intensity': [0, 0, 0]}]");
  EXPECT_EQ(warned(scene), "/lights ");
  scene["lights"] = json(kSun);
  EXPECT_EQ(warned(scene), "");
}

TEST(Warnings, ReportsMissingScattering) {
  Json scene = lit(kBall);
  scene["ambient"] = {0, 0, 0};
  scene["materials"]["white"] = json("{'type': 'subsurface', 'albedo': 0.9, 'mean_free_path': 0.1}");
  EXPECT_EQ(warned(scene), "/objects/0 ") << "the default technique does not scatter";
  scene["render"]["technique"] = "path";
  EXPECT_EQ(warned(scene), "/objects/0 ") << "the surface is smooth and the sun has no extent";
  Json rough = scene, sun = scene, sky = scene, clear = scene, open = scene;
  rough["materials"]["white"]["roughness"] = 0.2;
  EXPECT_EQ(warned(rough), "");
  sun["lights"][0]["angle_degrees"] = 0.53;
  EXPECT_EQ(warned(sun), "");
  sky["background"] = {1, 1, 1};
  EXPECT_EQ(warned(sky), "");
  clear["materials"]["white"]["albedo"] = 0;
  EXPECT_EQ(warned(clear), "");
  open["objects"][0] =
      json("{'type': 'disk', 'center': [0, 0, 0], 'normal': [0, 0, 1], 'radius': 1, 'material': 'white'}");
  EXPECT_EQ(warned(open), "") << "open surfaces only attenuate";
}

TEST(Warnings, ReportsEnergyCreatingMaterials) {
  Json scene = lit(kBall);
  scene["materials"]["white"] =
      json("{'type': 'metallic-roughness', 'base_color': 1, 'roughness': 0.5, 'strict': true}");
  EXPECT_EQ(warned(scene), "") << "no interreflection in this technique";
  scene["render"]["technique"] = "path";
  EXPECT_EQ(warned(scene), "/objects/0/material ");
  scene["materials"]["white"]["strict"] = false;
  EXPECT_EQ(warned(scene), "");
}

// A path from the floor that a smooth ball reflects or refracts hits a point, spot, line or parallel light
// with probability 0.
TEST(Warnings, ReportsLightsUnreachableThroughSmoothSurfaces) {
  covers("light-53");
  const auto with = [](const char* light, const char* ball) {
    Json scene =
        lit("{'type': 'plane', 'point': [0, -1, 0], 'normal': [0, 1, 0]}, {'type': 'sphere', 'center': "
            "[0, 0, 0], 'radius': 0.5, 'material': 'ball'}",
            {0, 0, 4}, light);
    scene["materials"]["ball"] = json(ball);
    scene["render"]["technique"] = "path";
    return scene;
  };
  const char *lantern = "[{'type': 'point', 'position': [1, 3, 1]}]",
             *spot = "[{'type': 'spot', 'position': [1, 3, 1], 'direction': [0, -1, 0]}]",
             *line = "[{'type': 'line', 'from': [1, 3, 1], 'to': [2, 3, 1]}]",
             *wide = "[{'type': 'directional', 'direction_to_light': [1, 1, 1], 'angle_degrees': 1}]",
             *dark = "[{'type': 'point', 'position': [1, 1, 1], 'intensity': [0, 0, 0]}]";
  const char *mirror = "{'type': 'metal', 'name': 'silver', 'roughness': 0}",
             *glass = "{'type': 'glass', 'roughness': 0}", *clear = "{'type': 'refractive', 'ior': 1.5}",
             *coat = "{'type': 'plastic', 'roughness': 0}", *frosted = "{'type': 'glass', 'roughness': 0.3}";
  for (const char* ball : {mirror, glass, clear, coat}) {
    for (const char* light : {lantern, spot, line, kSun})
      EXPECT_EQ(warned(with(light, ball)), "/lights/0 ") << light << ball;
    for (const char* light : {wide, dark, "[]"})
      EXPECT_EQ(warned(with(light, ball)).find("/lights/0"), std::string::npos) << light << ball;
  }
  EXPECT_EQ(warned(with(lantern, frosted)), "");
  Json mixed = with(lantern, frosted);
  mixed["materials"]["other"] = json(glass);
  EXPECT_EQ(warned(mixed), "") << "no object has this material";
  mixed["objects"][0]["material"] = "other";
  mixed["materials"]["ball"] = json("{'type': 'lambert'}");
  EXPECT_EQ(warned(mixed), "/lights/0 ");
  mixed["render"]["max_depth"] = 1;
  EXPECT_EQ(warned(mixed), "") << "paths are too short to reach a light";
  mixed["render"].erase("max_depth");
  mixed["render"]["technique"] = "whitted";
  EXPECT_EQ(warned(mixed), "");
  const auto scene = load(with("[{'type': 'point', 'position': [1, 3, 1]}]", glass));
  const std::string detail = find_warnings(*scene, make_plan(*scene, {})).at(0).detail;
  EXPECT_NE(detail.find("/objects/1"), std::string::npos) << detail;
  EXPECT_NE(detail.find("a sphere lamp of radius 0.02 m"), std::string::npos) << detail;
}

TEST(Warnings, CountsMirroredBackgroundAsLight) {
  Json scene = lit(kBall, {0, 0, 4}, "[]");
  scene["ambient"] = {0, 0, 0};
  scene["materials"]["white"] = json("{'type': 'reflective', 'n': [0.2, 0.2, 0.2], 'k': [3, 3, 3]}");
  scene["background"] = {0, 0, 0};
  EXPECT_EQ(warned(scene), "/lights ");
  scene["background"] = {0, 0, 0.2};
  EXPECT_EQ(warned(scene), "");
}

TEST(Warnings, ReportsCameraInsideOpaqueShape) {
  EXPECT_EQ(warned(lit(kBall, {0, 0, 0.9})), "/camera/eye ");
  EXPECT_EQ(warned(lit(kBall, {0, 0, 1.1})), "");
  EXPECT_EQ(warned(lit("{'type': 'box', 'min': [-1, -1, -1], 'max': [1, 1, 1]}", {0.9, 0.9, 0.9})),
            "/camera/eye ");
  EXPECT_EQ(warned(lit(kBall, {-0.7, -0.7, -0.7})), "") << "outside of the ball, but inside its bounding box";
  RenderRequest near;
  near.distance = 0.1;
  EXPECT_EQ(warned(lit(kBall), near), "/camera/eye ") << "the requested distance moves the eye into the ball";
}

TEST(Warnings, AcceptsCameraInsideLitRoom) {
  const char* room = "{'type': 'box', 'min': [-5, -5, -5], 'max': [5, 5, 5]}";
  EXPECT_EQ(warned(lit(room, {0, 0, 4}, "[{'type': 'point', 'position': [1, 1, 1]}]")), "");
  EXPECT_EQ(warned(lit(room, {0, 0, 4}, "[{'type': 'point', 'position': [1, 9, 1]}]")), "/camera/eye ");
  const char* dark = "[{'type': 'point', 'position': [1, 1, 1], 'intensity': [0, 0, 0]}]";
  EXPECT_EQ(warned(lit(room, {0, 0, 4}, dark)), "/camera/eye ");
}

TEST(Warnings, AcceptsCameraInsideFurnishedAmbientRoom) {
  const std::string room = "{'type': 'box', 'min': [-5, -5, -5], 'max': [5, 5, 5]}";
  Json furnished = lit((room + ", " + kBall).c_str());
  EXPECT_EQ(warned(furnished), "");
  furnished["ambient"] = {0, 0, 0};
  EXPECT_EQ(warned(furnished), "/camera/eye ") << "the sun is outside";
  EXPECT_EQ(warned(lit((room + ", {'type': 'sphere', 'center': [0, 0, 9], 'radius': 1}").c_str())),
            "/camera/eye ");
}

// The check tests each shape around the camera against each light, so it stops after eight shapes.
TEST(Warnings, StopsAfterEightShapesAroundCamera) {
  const auto warned_after = [](int lit_shapes) {
    Json scene = lit("", {0, 0, 4}, "[{'type': 'point', 'position': [0, 0, 5]}]");
    const auto add = [&](double radius) {
      scene["objects"].push_back(
          {{"type", "sphere"}, {"center", {0, 0, 4}}, {"radius", radius}, {"material", "white"}});
    };
    for (int i = 0; i < lit_shapes; ++i) add(5 + i);
    add(0.5);
    scene["ambient"] = {0, 0, 0};
    return warned(scene);
  };
  EXPECT_EQ(warned_after(7), "/camera/eye ");
  EXPECT_EQ(warned_after(8), "");
}

TEST(Warnings, AcceptsCameraInsideGlass) {
  Json scene = lit(kBall, {0, 0, 0.5});
  scene["materials"]["white"] = json("{'type': 'refractive', 'ior': 1.5}");
  EXPECT_EQ(warned(scene), "");
}

TEST(Warnings, ReportsEmptyView) {
  Json scene = lit(kBall);
  scene["camera"]["look_at"] = {0, 0, 9};
  EXPECT_EQ(warned(scene), "/camera ") << "the ball is behind the camera";
  scene["camera"]["look_at"] = {0, 9, -4};
  EXPECT_EQ(warned(scene), "/camera ") << "the ball is outside of the view";
  Json floor = lit("{'type': 'plane', 'point': [0, -1, 0], 'normal': [0, 1, 0]}");
  EXPECT_EQ(warned(floor), "") << "a plane is infinite";
}

TEST(Warnings, ReportsEmptyViewAndEnclosedCameraForInstances) {
  Json scene = lit("");
  scene["models"]["ball"]["objects"] = Json::array({json(kBall)});
  scene["models"]["ball"]["objects"][0]["material"] = "white";
  const auto with = [&](const char* instance) {
    Json placed = scene;
    placed["instances"] = Json::array({json(instance)});
    return warned(placed);
  };
  EXPECT_EQ(with("{'model': 'ball'}"), "");
  EXPECT_EQ(with("{'model': 'ball', 'translate': [0, 0, 20]}"), "/camera ");
  EXPECT_EQ(with("{'model': 'ball', 'translate': [0, 0, 3.5]}"), "/camera/eye ");
}

TEST(Warnings, ReportsEmptyViewFromTracedHits) {
  const auto scene = load(lit(kBall));
  const Plan plan = make_plan(*scene, {});
  TraceCounts traced;
  ASSERT_EQ(find_warnings(*scene, plan, traced).size(), 1u);
  EXPECT_EQ(find_warnings(*scene, plan, traced)[0].pointer, "/camera");
  traced.camera_hits = 1;
  EXPECT_TRUE(find_warnings(*scene, plan, traced).empty());
}

}  // namespace
}  // namespace orrery::test
