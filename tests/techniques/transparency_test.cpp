#include <gtest/gtest.h>

#include <cmath>

#include "core/plan/warnings.h"
#include "tests/support/covers.h"
#include "tests/support/materials.h"
#include "tests/support/pictures.h"
#include "tests/support/tracing.h"

// Tests transparency without refraction: the formulas on stacks of panes, and the energy that they report.
namespace orrery::test {
namespace {

const Vec3d kAmbient(0.5, 0.8, 1.0), kColor(0.9, 0.3, 0.1), kBackground(0.2, 0.5, 0.7);

// Returns `count` panes across the z axis before the background, lit by ambient light and by a light along
// the axis. Each pane casts a shadow on those behind it.
Json panes(int count, const Json& pane) {
  Json objects = Json::array();
  for (int i = 0; i < count; ++i)
    objects.push_back({{"type", "rectangle"},
                       {"corner", {-9, -9, -i}},
                       {"edge_u", {18, 0, 0}},
                       {"edge_v", {0, 18, 0}},
                       {"material", "pane"}});
  return scene_with(objects,
                    Json{{"materials", {{"white", nullptr}, {"pane", pane}}},
                         {"ambient", numbers(kAmbient)},
                         {"background", numbers(kBackground)},
                         {"lights", {{{"type", "directional"}, {"direction_to_light", {0, 0, 1}}}}}});
}
Json pane(const char* blend, double kt) {
  Json found{{"type", "transparent"}, {"kd", numbers(kColor)}, {"kt", kt}, {"blend", blend}};
  if (blend[0] == 'f') found["transmission_color"] = {1, 0.5, 0};
  return found;
}
RenderRequest depth(int max_depth) {
  RenderRequest request = size(1, 1);
  request.max_depth = max_depth;
  return request;
}

// Recursion of both formulas, from the last pane to the first. Only the first pane is lit directly.
Vec3d expected(int count, bool interpolated, double kt, double highlight = 0) {
  const Vec3d ct = interpolated ? Vec3d(1) : Vec3d(1, 0.5, 0);
  Vec3d light = kBackground;
  for (int i = count; i-- > 0;) {
    const Vec3d own = kColor * kAmbient + kColor * (i == 0 ? 1.0 : 0.0);
    light = own * (interpolated ? 1 - kt : 1) + ct * light * kt + Vec3d(i == 0 ? highlight : 0);
  }
  return light;
}

TEST(Transparency, BlendsPanesInOrderAlongRay) {
  covers("D1");
  Json scene = panes(2, pane("interpolated", 0.5));
  scene["materials"]["pane"]["kd"] = {1, 0, 0};
  scene["materials"]["blue"] = scene["materials"]["pane"];
  scene["materials"]["blue"]["kd"] = {0, 0, 1};
  scene["objects"][1]["material"] = "blue";
  std::swap(scene["objects"][0], scene["objects"][1]);
  scene["lights"] = Json::array();
  scene["ambient"] = {1, 1, 1};
  scene["background"] = {0, 0, 0};
  EXPECT_EQ(Tracing(scene, depth(5)).trace(Ray<double>{{0, 0, 4}, {0, 0, -1}}).radiance, Vec3d(0.5, 0, 0.25));
}

TEST(Transparency, MatchesFormulasOnStacksOfPanes) {
  covers("D2");
  double worst = 0;
  for (const char* blend : {"interpolated", "filtered"})
    for (const double kt : {0.0, 0.25, 0.5, 1.0})
      for (int count = 1; count <= 5; ++count) {
        const Vec3d right = expected(count, blend[0] == 'i', kt);
        const Json scene = panes(count, pane(blend, kt));
        const Vec3d exact = Tracing(scene, depth(5)).trace(Ray<double>{{0, 0, 4}, {0, 0, -1}}).radiance;
        worst = std::max(worst, length(exact - right));
        const Vec3f single = render(scene, in_float(depth(5))).pixels.front();
        EXPECT_LE(length(Vec3d(single) - right), 2e-6) << blend << kt << count;
      }
  EXPECT_LE(worst, 1e-15);
  RecordProperty("worst_error_in_double", std::to_string(worst));
}

TEST(Transparency, AddsWholeHighlightOfFrontSurface) {
  for (const char* blend : {"interpolated", "filtered"}) {
    Json shiny = pane(blend, 0.75);
    shiny["ks"] = 0.5;
    const Vec3d found = Tracing(panes(3, shiny), depth(5)).trace(Ray<double>{{0, 0, 4}, {0, 0, -1}}).radiance;
    EXPECT_LE(length(found - expected(3, blend[0] == 'i', 0.75, 0.5)), 1e-15) << blend;
  }
}

// Ambient light replaces the light from behind the last pane within the depth limit.
TEST(Transparency, EndsAtDepthLimit) {
  Tracing tracing(panes(3, pane("interpolated", 0.5)), depth(1));
  const TraceOutput found = tracing.trace(Ray<double>{{0, 0, 4}, {0, 0, -1}});
  const Vec3d own = kColor * kAmbient;
  const Vec3d right = (own + kColor) * 0.5 + (own * 0.5 + kAmbient * 0.5) * 0.5;
  EXPECT_LE(length(found.radiance - right), 1e-15);
  EXPECT_EQ(found.cut, 0.25);
}

TEST(Transparency, ContinuesRaysInTheirDirection) {
  Tracing tracing(panes(2, pane("filtered", 0.5)), depth(5));
  const Vec3d direction = safe_normalize(Vec3d(0.3, 0.2, -1));
  tracing.trace(Ray<double>{{0, 0, 4}, direction});
  int rays = 0;
  for (const auto& generation : tracing.rays())
    for (const auto& ray : generation) {
      EXPECT_EQ(ray.direction, direction);
      ++rays;
    }
  EXPECT_EQ(rays, 3);
}

// The technique path sees the panes as whitted does: its only source is the background.
TEST(Transparency, HasSameMeanInPathAndWhitted) {
  for (const char* blend : {"interpolated", "filtered"}) {
    Json scene = panes(3, pane(blend, 0.6));
    scene["lights"] = Json::array();
    scene["ambient"] = {0, 0, 0};
    scene["materials"]["pane"]["kd"] = 0;
    const Vec3d right = Tracing(scene, depth(8)).trace(Ray<double>{{0, 0, 4}, {0, 0, -1}}).radiance;
    const Estimate found = estimate(scene, {0, 0, 4}, {0, 0, 0}, 8);
    EXPECT_NEAR(found.mean, right.x, 5 * found.error() + 1e-12) << blend;
  }
}

TEST(Transparency, ReportsCreatedEnergy) {
  const auto warned = [](const Json& material, const char* technique) {
    const auto scene = load(panes(1, material));
    RenderRequest request = depth(5);
    request.technique = technique;
    std::string text;
    for (const Problem& problem : find_warnings(*scene, make_plan(*scene, request))) text += problem.detail;
    return text.find("reflects and transmits up to 140 %") != std::string::npos;
  };
  for (const char* technique : {"whitted", "path"}) {
    EXPECT_TRUE(warned(pane("filtered", 0.5), technique)) << technique;
    EXPECT_FALSE(warned(pane("interpolated", 0.5), technique)) << technique;
    EXPECT_FALSE(warned(pane("filtered", 0.1), technique)) << technique;
  }
  EXPECT_FALSE(warned(pane("filtered", 0.5), "raycast"));
}

TEST(Transparency, BoundsLightOfStacks) {
  const auto most = [](const Json& material) { return load(panes(1, material))->facts.tree_radiance.most; };
  const Vec3d bound = most(pane("filtered", 0.5));
  for (int count = 1; count <= 5; ++count) {
    const Vec3d found = expected(count, false, 0.5);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_LE(found[c], bound[c]);
  }
  EXPECT_NEAR(bound.x, kColor.x * (kAmbient.x + 1) / (1 - 0.5), 1e-12);
  EXPECT_TRUE(std::isinf(most(pane("filtered", 2)).x)) << "each further pane doubles the light";
}

TEST(Transparency, RejectsInvalidCoefficients) {
  const auto problem = [](const Json& material) { return first_problem(panes(1, material)); };
  EXPECT_EQ(problem(pane("interpolated", 1.5)), "/materials/pane/kt");
  EXPECT_EQ(problem(pane("filtered", 1.5)), "accepted");
  Json colored = pane("interpolated", 0.5);
  colored["transmission_color"] = {1, 0, 0};
  EXPECT_EQ(problem(colored), "/materials/pane/transmission_color");
}

TEST(Transparency, MarksMaterialAsStraight) {
  EXPECT_TRUE(Probe<double>(pane("filtered", 0.5)).traits().straight);
  EXPECT_FALSE(Probe<double>(pane("filtered", 0)).traits().straight);
  EXPECT_FALSE(Probe<double>("{'type': 'refractive', 'ior': 1.5}").traits().straight);
}

}  // namespace
}  // namespace orrery::test
