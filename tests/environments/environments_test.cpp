#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/environments/light_map.h"
#include "core/environments/registry.h"
#include "tests/environments/support.h"
#include "tests/support/covers.h"
#include "tests/support/pictures.h"
#include "tests/support/random.h"

namespace orrery::test {
namespace {

constexpr double kPi = std::numbers::pi;

Vec3d tilted(double angle) { return {std::sin(angle), std::cos(angle), 0}; }

// Returns the mean pixel value of an image of the floor with 262,144 samples. Paths end at the sky.
double floor_mean(const std::shared_ptr<const Scene>& scene) {
  RenderRequest request = size(64, 64);
  request.technique = "path";
  request.max_depth = 1;
  request.samples = 64;
  return render(scene, request).sum() / (64 * 64);
}
Json floor_under(const Json& environment, const Vec3d& normal) {
  Json scene = scene_of("[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0]}]",
                        "{'materials': {'white': {'type': 'lambert', 'kd': null, 'reflectance': 1}}}");
  scene["objects"][0]["normal"] = numbers(normal);
  scene["camera"] = {{"type", "orthographic"},
                     {"eye", numbers(normal * 5)},
                     {"look_at", {0, 0, 0}},
                     {"up", {0, 0, 1}},
                     {"height", 2}};
  scene["environment"] = environment;
  return scene;
}

TEST(Environments, HasTestsForAllTypes) { ASSERT_EQ(environment_types().size(), 3u); }

TEST(GradientEnvironment, MatchesAnalyticIrradiance) {
  covers("light-33");
  const Json half_plus_half_cosine = {
      {"type", "gradient"}, {"zenith", {1, 1, 1}}, {"horizon", {0.5, 0.5, 0.5}}, {"ground", {0, 0, 0}}};
  EXPECT_NEAR(floor_mean(load(floor_under(half_plus_half_cosine, tilted(0)))), 5.0 / 6, 1e-3);
  const Json half_white = {
      {"type", "gradient"}, {"zenith", {1, 1, 1}}, {"horizon", {1, 1, 1}}, {"ground", {0, 0, 0}}};
  for (const double angle : {0.3, 0.8, 1.5})
    EXPECT_NEAR(floor_mean(load(floor_under(half_white, tilted(angle)))), (1 + std::cos(angle)) / 2, 1e-3);
}

TEST(GradientEnvironment, IsVisibleToRaysInEveryTechnique) {
  const Json scene = floor_under(
      {{"type", "gradient"}, {"zenith", {4, 1, 1}}, {"horizon", {2, 1, 1}}, {"ground", {0.5, 1, 1}}},
      tilted(0));
  for (const char* technique : {"raycast", "whitted", "distributed", "path"}) {
    RenderRequest request;
    request.technique = technique;
    Tracing tracing(scene, request);
    const auto seen = [&](const Vec3d& from, const Vec3d& along) {
      return tracing.trace({from, safe_normalize(along)}).radiance.x;
    };
    EXPECT_NEAR(seen(Vec3d(0, 1, 0), Vec3d(0, 1, 0)), 4, 1e-12) << technique;
    EXPECT_NEAR(seen(Vec3d(0, 1, 0), Vec3d(3, 4, 0)), 2 + 2 * 0.8, 1e-12) << technique;
    EXPECT_NEAR(seen(Vec3d(0, -1, 0), Vec3d(3, -4, 0)), 0.5, 1e-12) << technique;
  }
}

TEST(ConstantEnvironment, MatchesBackground) {
  Json scene = sample("cornell-box");
  scene["image"] = {{"width", 32}, {"height", 32}};
  scene["background"] = {0.3, 0.2, 0.1};
  const Picture by_background = render(scene);
  scene.erase("background");
  scene["environment"] = {{"type", "constant"}, {"radiance", {0.3, 0.2, 0.1}}};
  EXPECT_TRUE(identical(by_background, render(scene)));
  scene["background"] = {0, 0, 0};
  EXPECT_EQ(first_problem(scene), "/background");
}

TEST(ImageEnvironment, MatchesAnalyticIrradianceOfHalfWhiteSky) {
  covers("light-33");
  const Texels half = painted(64, 128, [](int, int y) { return Vec3d(y < 64 ? 1 : 0); });
  for (const double angle : {0.0, 0.8, 1.5}) {
    Json scene = floor_under({{"type", "image"}, {"file", "sky.exr"}}, tilted(angle));
    EXPECT_NEAR(floor_mean(load_scene(parse_document(scene.dump()), SingleImageSource(half))),
                (1 + std::cos(angle)) / 2, 2e-3)
        << angle;
  }
}

// Compares the floor under a rotated sky of random bright spots with a sum over a fine grid of directions.
TEST(ImageEnvironment, MatchesSumOverDirections) {
  covers("light-22");
  Random random(3);
  const Texels picture =
      painted(16, 8, [&](int, int) { return Vec3d(random.unit() < 0.1 ? 30.0 : random.unit()); });
  const LightMap map(picture);
  const Vec3d normal = safe_normalize(Vec3d(1, 2, 0.5));
  constexpr double kDegrees = 70, kScale = 0.5;
  constexpr int kSteps = 1000;
  double sum = 0;
  for (int row = 0; row < kSteps; ++row)
    for (int column = 0; column < kSteps; ++column) {
      const double angle = kPi * (row + 0.5) / kSteps, turn = 2 * kPi * (column + 0.5) / kSteps;
      const Vec3d direction(std::sin(angle) * std::sin(turn), std::cos(angle),
                            std::sin(angle) * std::cos(turn));
      const double cosine = dot(direction, normal);
      if (cosine <= 0) continue;
      const double back = turn - kDegrees * kPi / 180;  // the sky's azimuth before its rotation
      const auto place = map.place_of(
          Vec3d(std::sin(angle) * std::sin(back), std::cos(angle), std::sin(angle) * std::cos(back)));
      sum += map.at(place.x, place.y).radiance.x * cosine * std::sin(angle);
    }
  const double expected = kScale * sum * 2 * kPi / (double{kSteps} * kSteps);  // irradiance / pi
  Json scene = floor_under(
      {{"type", "image"}, {"file", "f"}, {"rotation_degrees", kDegrees}, {"scale", kScale}}, normal);
  EXPECT_NEAR(floor_mean(load_scene(parse_document(scene.dump()), SingleImageSource(picture))) / expected, 1,
              3e-3);
  // With a second light, each light is sampled with probability 1/2.
  scene["lights"] = Json::array(
      {{{"type", "directional"}, {"direction_to_light", numbers(normal)}, {"intensity", {3, 3, 3}}}});
  EXPECT_NEAR(floor_mean(load_scene(parse_document(scene.dump()), SingleImageSource(picture))), expected + 3,
              5e-3 * (expected + 3));
}

// Expects the radiance and density of light samples to equal the results of beyond() for rays in the same
// directions.
template <class T>
void expect_draws_as_seen(const Scene& scene, T tolerance) {
  const LightKernelPtr<T> kernel = scene.environment->kernel(T());
  const LaneGroups all = LaneGroups::covering(0, kBatch, kWidth<T>);
  const auto surface = std::make_unique<SurfaceBatch<T>>();
  const auto choices = std::make_unique<LightChoices<T>>();
  const auto out = std::make_unique<LightBatch<T>>();
  const auto rays = std::make_unique<RayBatch<T>>();
  const auto radiance = std::make_unique<Vec3Array<T>>();
  const auto pdf = std::make_unique<Array<T>>();
  const auto slot = std::make_unique<Array<IndexOf<T>>>();
  for (int i = 0; i < kBatchRoom; ++i) {
    choices->index[i] = 0;
    choices->probability[i] = T(0.5);
    (*slot)[i] = static_cast<IndexOf<T>>(i % kBatch);
  }
  const Draws draws(9, TileView{0, 0, kTileSide, kTileSide}, 1);
  kernel->sample_each(*surface, *choices, PathDraws<T>{draws, *slot, 2}, all, *out);
  rays->direction = out->shadow.direction;
  kernel->beyond(*rays, {0, T(0.5)}, all, *radiance, *pdf);
  for (int i = 0; i < kBatch; ++i) {
    ASSERT_GT(out->shadow.t_max[i], 0);
    ASSERT_NEAR((*pdf)[i] / out->pdf[i], T(1), tolerance);
    ASSERT_NEAR(out->incident[i].x * std::numbers::pi_v<T> * out->pdf[i] / (*radiance)[i].x, T(1), tolerance);
  }
}
TEST(ImageEnvironment, LightSamplesMatchRadianceAndDensityAlongRays) {
  covers("light-24");
  Random random(8);
  const Texels picture = painted(32, 16, [&](int, int) { return Vec3d(0.1 + random.unit()); });
  const auto scene = surrounded(picture, Vec3d(0, 1, 0), {{"rotation_degrees", 123}});
  ASSERT_TRUE(scene->environment->sampled());
  expect_draws_as_seen<double>(*scene, 1e-10);
  expect_draws_as_seen<float>(*scene, 5e-3f);
}

TEST(ImageEnvironment, RotatesAnticlockwiseFromAbove) {
  const Texels picture = painted(8, 4, [](int x, int) { return Vec3d(x); });
  const auto seen = [&](double degrees, const Vec3d& along) {
    Tracing tracing(surrounded(picture, Vec3d(0, 1, 0), {{"rotation_degrees", degrees}}));
    return tracing.trace({Vec3d(0, 1, 0), along}).radiance.x;
  };
  EXPECT_NEAR(seen(0, Vec3d(0, 0, -1)), 3.5, 1e-12);
  EXPECT_NEAR(seen(0, Vec3d(1, 0, 0)), 5.5, 1e-12);
  EXPECT_NEAR(seen(90, Vec3d(-1, 0, 0)), 3.5, 1e-12);
  EXPECT_NEAR(seen(90, Vec3d(0, 0, -1)), 5.5, 1e-12);
}

TEST(ImageEnvironment, IsBitIdenticalAcrossThreadsAndScales) {
  Random random(8);
  const Texels picture = painted(32, 16, [&](int, int) { return Vec3d(random.unit()); });
  const auto picture_of = [&](const Json& scene, int threads) {
    RenderRequest request = size(48, 32);
    request.technique = "path";
    request.samples = 2;
    return render(load_scene(parse_document(scene.dump()), SingleImageSource(picture)), request, threads);
  };
  Json scene = sample("cornell-box");
  scene["environment"] = {{"type", "image"}, {"file", "f"}};
  scene["lights"] = Json::array(
      {{{"type", "line"}, {"from", {1, 5, 1}}, {"to", {2, 5, 1.5}}, {"intensity_per_metre", {1, 2, 3}}},
       {{"type", "directional"}, {"direction_to_light", {1, 1, 1}}, {"angle_degrees", 8}}});
  scene.erase("background");
  EXPECT_TRUE(identical(picture_of(scene, 1), picture_of(scene, 3)));
  scene["lights"].erase(1);  // with two lights, light selection depends on the size of the scene
  const Picture one = picture_of(scene, 1);
  EXPECT_TRUE(identical(one, picture_of(scaled(scene, 0x1p-17), 0)));
  EXPECT_TRUE(identical(one, picture_of(scaled(scene, 0x1p17), 0)));
}

TEST(ImageEnvironment, ReportsPointersOfInvalidFields) {
  const auto problem = [](const Json& environment) {
    Json scene = scene_of("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}]");
    scene["environment"] = environment;
    return first_problem(scene);
  };
  EXPECT_EQ(problem({{"type", "image"}, {"file", "sky.exr"}}), "/environment/file");
  EXPECT_EQ(problem({{"type", "image"}, {"asset", "00"}}), "/environment/asset");
  EXPECT_EQ(problem({{"type", "image"}}), "/environment");
  EXPECT_EQ(problem({{"type", "sky"}}), "/environment/type");
  EXPECT_EQ(problem({{"zenith", {1, 1, 1}}}), "/environment");
  EXPECT_EQ(problem({{"type", "gradient"}, {"zenith", {1, 1, -1}}}), "/environment/zenith/2");
}

}  // namespace
}  // namespace orrery::test
