#include <gtest/gtest.h>

#include <thread>

#include "core/accelerators/registry.h"
#include "core/plan/plan.h"
#include "core/prepare/prepared_scene.h"
#include "tests/support/covers.h"
#include "tests/support/pictures.h"

// Tests images of moving scenes.
namespace orrery::test {
namespace {

RenderRequest at_time(double time, RenderRequest request = size(96, 72)) {
  request.time = time;
  return request;
}

// Returns a plate whose middle rises, and a peg that rotates, moves and grows.
Json moving_scene() {
  return scene_of(
      R"([{'type': 'plane', 'point': [0, -1, 0], 'normal': [0, 1, 0]},
          {'type': 'mesh', 'crease_degrees': 60, 'positions': [[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1], [0, 0, 0]],
           'indices': [[4, 1, 0], [4, 2, 1], [4, 3, 2], [4, 0, 3]],
           'motion': [{'time': 1}, {'time': 3, 'positions': [[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0.5, 1], [0, 1, 0.25]]},
                      {'time': 4, 'positions': [[-1, 0, -1], [2, 0, -1], [1, 0, 1], [-1, 0, 1], [0, 1, 0]]}]}])",
      R"({'camera': {'eye': [1, 3, 6], 'type': 'perspective', 'look_at': [0, 0, 0]},
          'lights': [{'type': 'point', 'position': [2, 5, 3]}],
          'models': {'peg': {'objects': [{'type': 'cylinder', 'base': [0, 0, 0], 'top': [0.3, 1, 0], 'radius': 0.2, 'material': 'white'}]}},
          'instances': [{'model': 'peg', 'scale': [1, 2, 1], 'rotate': {'axis': [0, 0, 1], 'degrees': 10}, 'translate': [-1.5, 0, 0],
                         'motion': [{'time': 0, 'degrees': -20}, {'time': 2, 'translate': [-1, 0, 1]},
                                    {'time': 4, 'scale': [2, 1, 1], 'degrees': 700}]}]})");
}

// Returns the moving scene as it is at 2.5 s, without motion.
Json standing_scene() {
  Json scene = moving_scene();
  Json& mesh = scene["objects"][1];
  for (std::size_t v = 0; v < 5; ++v) {
    const Vec3d from = vector(mesh["positions"][v]), to = vector(mesh["motion"][1]["positions"][v]);
    mesh["positions"][v] = numbers(from * 0.25 + to * 0.75);
  }
  mesh.erase("motion");
  Json& peg = scene["instances"][0];
  peg["scale"] = {0.75 * 1 + 0.25 * 2, 0.75 * 2 + 0.25 * 1, 1};
  peg["rotate"]["degrees"] = 0.75 * 10 + 0.25 * 700;
  peg["translate"] = {0.75 * -1 + 0.25 * -1.5, 0, 0.75 * 1 + 0.25 * 0};
  peg.erase("motion");
  return scene;
}

TEST(Motion, MatchesStaticSceneAtEachTime) {
  covers("F19");
  const auto moving = load(moving_scene());
  for (const RenderRequest& in : {in_float(size(96, 72)), in_double(size(96, 72))}) {
    const Picture expected = render(standing_scene(), in);
    EXPECT_TRUE(identical(render(moving, at_time(2.5, in)), expected));
    EXPECT_GT(differing_pixels(render(moving, at_time(2.4, in)), expected, 1e-3), 100);
  }
}

TEST(Motion, IsIndependentOfEarlierTimes) {
  covers("F19");
  const auto scene = load(moving_scene());
  for (const auto& type : accelerator_types()) {
    RenderRequest request = size(96, 72);
    request.accelerator = type.name;
    const PreparedScene prepared(scene);
    for (const double time : {0.0, 1.0, 1.5, 4.0, 2.5, 2.25, 0.0, 9.0}) {
      const Plan plan = make_plan(*scene, at_time(time, request));
      const Image image =
          render_frame(prepared, settle(prepared, plan), FilmStorage::linear32, shared_executor())
              .film.image(PixelFormat::linear32);
      const Picture alone = render(scene, at_time(time));
      int wrong = 0;
      for (int y = 0; y < 72; ++y)
        for (int x = 0; x < 96; ++x) wrong += image.linear(x, y) != alone.at(x, y);
      EXPECT_EQ(wrong, 0) << type.name << " at " << time;
    }
    EXPECT_EQ(prepared.parts().made_float.moments.size(), PreparedScene::kMoments);
  }
}

TEST(Motion, HoldsFirstAndLastKeyframeOutsideMotion) {
  const auto scene = load(moving_scene());
  EXPECT_EQ(scene->motion.first, 0);
  EXPECT_EQ(scene->motion.last, 4);
  EXPECT_TRUE(identical(render(scene, at_time(-3)), render(scene, at_time(0))));
  EXPECT_TRUE(identical(render(scene, at_time(1e6)), render(scene, at_time(4))));
  EXPECT_EQ(make_plan(*scene, at_time(77)).time, 4);
  Json own = moving_scene();
  own["render"]["time"] = 3.5;
  EXPECT_TRUE(identical(render(own, size(96, 72)), render(scene, at_time(3.5))));
}

TEST(Motion, WrapsTimeInLoop) {
  constexpr TimeSpan span{2, 5}, none{};
  const std::pair<double, double> moments[] = {{2, 2}, {5, 5},  {5.5, 2.5},  {8, 2},
                                               {1, 4}, {-1, 2}, {3.25, 3.25}};
  for (const auto& [time, moment] : moments) EXPECT_EQ(span.moment_of_loop(time), moment) << time;
  EXPECT_EQ(none.moment_of_loop(7), 0);
}

TEST(Motion, PlansForAllTimesTogether) {
  Json far = moving_scene();
  far["instances"][0]["motion"][1]["translate"] = {3e7, 0, 0};
  EXPECT_FALSE(make_plan(*load(moving_scene()), at_time(0)).double_precision);
  EXPECT_TRUE(make_plan(*load(far), at_time(0)).double_precision)
      << "all frames must have the same number type";
  Json stretched = moving_scene();
  stretched["objects"][1]["motion"][2]["positions"][0] = {-3e7, 0, 0};
  EXPECT_TRUE(make_plan(*load(stretched), at_time(0)).double_precision);
}

// Returns a smooth or flat dome in the shadow of a ball. One triangle grows from zero area, and a distant
// vertex is unused.
Json dome(double petal, bool moving, bool smooth) {
  Json mesh = {{"type", "mesh"}};
  if (smooth) mesh["crease_degrees"] = 180;
  Json grown = Json::array();
  const auto add = [&](const Vec3d& at, const Vec3d& later) {
    mesh["positions"].push_back(numbers(moving ? at : at * (1 - petal) + later * petal));
    grown.push_back(numbers(later));
  };
  add({0, 1, 0}, {0, 1, 0});
  for (int i = 0; i < 6; ++i) {
    const Vec3d rim(std::cos(i), 0, std::sin(i));
    add(i == 5 ? Vec3d(0, 1, 0) : rim, rim);
    if (i > 0 && (i < 5 || moving || petal > 0)) mesh["indices"].push_back({0, i + 1, i});
  }
  if (moving) {
    add({2e6, 0, 0}, {2e6, 0, 0});
    mesh["motion"] = {{{"time", 0}}, {{"time", 1}, {"positions", grown}}};
  }
  return scene_with({mesh, json("{'type': 'sphere', 'center': [0.5, 1.8, 0.25], 'radius': 0.25}")},
                    json("{'camera': {'type': 'perspective', 'eye': [0.5, 2, 3], 'look_at': [0, 0, 0]},"
                         " 'lights': [{'type': 'point', 'position': [2, 5, 1]}]}"));
}

TEST(Motion, IgnoresDegenerateTrianglesAndUnusedVertices) {
  covers("F19");
  for (const double petal : {0.0, 0.5, 1.0})
    for (const RenderRequest& in : {in_float(size(96, 72)), in_double(size(96, 72))})
      for (const bool smooth : {false, true})
        EXPECT_TRUE(identical(render(dome(0, true, smooth), at_time(petal, in)),
                              render(dome(petal, false, smooth), in)))
            << petal;
  EXPECT_FALSE(make_plan(*load(dome(0, true, false)), at_time(0)).double_precision);
}

// The two halves of a roof move together and then separate along the ridge. Coincident vertices are smoothed
// together while the ridge is closed.
TEST(Motion, SmoothsCoincidentVerticesTogether) {
  covers("F19");
  const auto roof = [](double lift, double gap) {
    return Json{{-1, 0, -1},     {-gap, lift, -1}, {-gap, lift, 1}, {-1, 0, 1},
                {gap, lift, -1}, {1, 0, -1},       {1, 0, 1},       {gap, lift, 1}};
  };
  const auto scene = [&](const Json& positions) {
    Json mesh = {{"type", "mesh"}, {"crease_degrees", 180}, {"positions", positions}};
    mesh["indices"] = {{0, 2, 1}, {0, 3, 2}, {4, 6, 5}, {4, 7, 6}};
    return scene_with(mesh,
                      json("{'camera': {'type': 'perspective', 'eye': [0.5, 2, 3], 'look_at': [0, 0, 0]},"
                           " 'lights': [{'type': 'point', 'position': [2, 5, 1]}]}"));
  };
  Json moving = scene(roof(0.2, 0));
  moving["objects"][0]["motion"] = {{{"time", 0}},
                                    {{"time", 1}, {"positions", roof(0.6, 0)}},
                                    {{"time", 2}, {"positions", roof(0.6, 0.5)}}};
  const std::pair<double, Json> moments[] = {
      {0, roof(0.2, 0)}, {0.5, roof(0.4, 0)}, {1.5, roof(0.6, 0.25)}, {2, roof(0.6, 0.5)}};
  for (const auto& [time, positions] : moments)
    EXPECT_TRUE(identical(render(moving, at_time(time)), render(scene(positions), size(96, 72)))) << time;
}

// All vertices coincide at half the time. This must not affect the smoothing groups.
TEST(Motion, SupportsMeshCollapsingToPoint) {
  covers("F19");
  Json mesh = {{"type", "mesh"}, {"crease_degrees", 60}}, mirrored = Json::array();
  constexpr int kSteps = 20'000;
  for (int i = 0; i < 2 * kSteps; ++i) {
    const Vec3d at(4.0 * (i / 2) / kSteps - 2, i % 2 ? 1 : -1, 0.2 * std::sin(0.001 * i));
    mesh["positions"].push_back(numbers(at));
    mirrored.push_back(numbers(-at));
    if (i >= 2) mesh["indices"].push_back({i - 2, i - 1, i});
  }
  mesh["motion"] = {{{"time", 0}}, {{"time", 1}, {"positions", mirrored}}};
  const auto scene =
      load(scene_with(mesh, json("{'lights': [{'type': 'directional', 'direction_to_light': [0, 0, 1]}]}")));
  EXPECT_NO_THROW(render(scene, at_time(0.5)));
  EXPECT_GT(render(scene, at_time(0.6)).brighter_than(0.1f), 10);
}

TEST(Motion, RendersSeveralTimesConcurrently) {
  const auto scene = load(moving_scene());
  const PreparedScene prepared(scene);
  std::vector<Picture> expected;
  for (int i = 0; i < 4; ++i) expected.push_back(render(scene, at_time(i, size(32, 24))));
  std::atomic<int> wrong = 0;
  std::vector<std::jthread> callers;
  for (int caller = 0; caller < 4; ++caller)
    callers.emplace_back([&, caller] {
      for (int frame = 0; frame < 12; ++frame) {
        const int i = (caller + frame) % 4;
        const Plan plan = make_plan(*scene, at_time(i, size(32, 24)));
        const Image image =
            render_frame(prepared, settle(prepared, plan), FilmStorage::linear32, shared_executor())
                .film.image(PixelFormat::linear32);
        for (int y = 0; y < 24; ++y)
          for (int x = 0; x < 32; ++x)
            wrong += image.linear(x, y) != expected[static_cast<std::size_t>(i)].at(x, y);
      }
    });
  callers.clear();
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace orrery::test
