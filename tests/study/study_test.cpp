#include "core/study/study.h"

#include <gmock/gmock.h>

#include <set>

#include "core/base/error.h"
#include "core/plan/limits.h"
#include "tests/support/pictures.h"

// The ladder of ways to make a picture, and what is measured on it.
namespace orrery::test {
namespace {

RenderResult made(const PreparedScene& scene, const RenderRequest& request) {
  return render_frame(scene, settle(scene, make_plan(scene.scene(), request)), FilmStorage::linear32,
                      shared_pool());
}

Chart chart_of(const Json& scene, const RenderRequest& view, const Study::Extent& extent) {
  const PreparedScene prepared(load(scene));
  Study study(prepared.scene(), view, extent);
  for (int number = 0; number < study.pictures(); ++number) {
    EXPECT_FALSE(study.complete());
    study.add(made(prepared, study.request(number)));
  }
  EXPECT_TRUE(study.complete());
  return study.chart();
}

const Point& find(const Chart& chart, const Configuration& configuration) {
  for (const Point& p : chart.points)
    if (line_name(p.configuration) == line_name(configuration) &&
        p.configuration.samples == configuration.samples)
      return p;
  throw std::runtime_error("no such point");
}

std::vector<std::string> lines_of(const Chart& chart) {
  std::vector<std::string> names;
  for (const Point& p : chart.points)
    if (names.empty() || names.back() != line_name(p.configuration))
      names.push_back(line_name(p.configuration));
  return names;
}

TEST(Study, TriesNoModelThatTheSceneDoesNotNeed) {
  const auto glass = load(sample("glass"));
  EXPECT_THAT(lines_of(Study(*glass, {}, {}).chart()),
              testing::ElementsAre("raycast 0", "raycast 0, double", "whitted 1", "whitted 1, double",
                                   "whitted 2", "whitted 2, double", "whitted 12", "whitted 12, double"));
  RenderRequest shallow;
  shallow.max_depth = 1;
  EXPECT_THAT(lines_of(Study(*glass, shallow, {}).chart()),
              testing::ElementsAre("raycast 0", "raycast 0, double", "whitted 1", "whitted 1, double"));
  const auto rough = load(scene_of("{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}"));
  EXPECT_EQ(lines_of(Study(*rough, {}, {}).chart()).size(), 2U);
}

TEST(Study, LeavesOutWhatTurnsOutToBeTheSame) {
  const Chart chart = chart_of(sample("flag"), size(24, 24), {.samples = 4, .rounds = 1});
  EXPECT_THAT(lines_of(chart),
              testing::ElementsAre("raycast 0", "raycast 0, double", "whitted 1", "whitted 1, double"));
  EXPECT_EQ(chart.reference.max_depth, 5);
}

TEST(Study, TurnsThroughTheRungsRoundByRoundWithOtherSeeds) {
  RenderRequest view = size(30, 20);
  view.seed = kMaxSeed - 1;
  view.max_depth = 1;
  const auto scene = load(sample("glass"));
  const Study study(*scene, view, {.samples = 20, .rounds = 2});
  constexpr int kRungs = 2 * 2 * 3;  // models, precisions, and 1, 4, 16 samples
  EXPECT_EQ(study.pictures(), 2 + 2 * kRungs);
  for (const int number : {0, 1}) {
    EXPECT_EQ(study.request(number).samples, 64);
    EXPECT_EQ(study.request(number).precision, Precision::double_precision);
  }
  EXPECT_EQ(study.request(2).technique, "raycast");
  EXPECT_EQ(study.request(4).samples, 16);
  EXPECT_EQ(study.request(2 + kRungs).technique, "raycast");
  std::set<std::uint64_t> seeds;
  for (int number = 0; number < study.pictures(); ++number) {
    const RenderRequest request = study.request(number);
    EXPECT_LE(*request.seed, std::uint64_t{kMaxSeed});
    EXPECT_EQ(request.width, 30);
    seeds.insert(*request.seed);
    make_plan(*scene, request);
  }
  EXPECT_THAT(seeds, testing::ElementsAre(0, 1, kMaxSeed - 1, kMaxSeed));
}

TEST(Study, SeesErrorsShrinkWithSamplesToWhatTheModelLacks) {
  const Chart chart = chart_of(sample("glass"), size(48, 48), {.samples = 64, .rounds = 2});
  const auto rmse = [&](const char* technique, int depth, bool doubles, int samples) {
    return find(chart, {technique, depth, doubles, samples}).rmse();
  };
  for (const bool doubles : {false, true}) {
    EXPECT_LT(rmse("whitted", 12, doubles, 4), rmse("whitted", 12, doubles, 1));
    EXPECT_LT(rmse("whitted", 12, doubles, 16), rmse("whitted", 12, doubles, 4) / 2);
    EXPECT_LT(rmse("whitted", 12, doubles, 64), rmse("whitted", 12, doubles, 16) / 2);
    EXPECT_GT(rmse("raycast", 0, doubles, 64), 10 * rmse("whitted", 12, doubles, 64));
  }
  EXPECT_LT(chart.reference_rmse, rmse("whitted", 12, true, 64));
  EXPECT_GT(chart.reference_rmse, 0);
}

TEST(Study, MeasuresWhatAnyoneWould) {
  const Json scene = sample("paper");
  const RenderRequest view = size(24, 16);
  const Chart chart = chart_of(scene, view, {.samples = 4, .rounds = 1});
  const auto prepared = load(scene);
  Study again(*prepared, view, {.samples = 4, .rounds = 1});
  const Picture first = render(scene, again.request(0)), second = render(scene, again.request(1)),
                configuration = render(scene, again.request(3));
  double squares = 0, between = 0;
  for (std::size_t i = 0; i < configuration.pixels.size(); ++i) {
    const auto add = [&](float Vec3f::*c) {
      squares +=
          std::pow(configuration.pixels[i].*c - (double(first.pixels[i].*c) + second.pixels[i].*c) / 2, 2);
      between += std::pow(double(first.pixels[i].*c) - second.pixels[i].*c, 2);
    };
    add(&Vec3f::x);
    add(&Vec3f::y);
    add(&Vec3f::z);
  }
  const double count = 3.0 * double(configuration.pixels.size());
  EXPECT_NEAR(chart.points[1].rmse(), std::sqrt(squares / count), 1e-7);
  EXPECT_NEAR(chart.reference_rmse, std::sqrt(between / count) / 2, 1e-7);
  EXPECT_EQ(chart.points[1].rays(), double(configuration.stats.counts.rays.total()));
  EXPECT_GT(chart.points[1].cpu_ms(), 0);
}

TEST(Study, RefusesWhatItVariesItselfAndWhatIsTooLarge) {
  RenderRequest view = size(2000, 1000);
  view.samples = 4;
  view.precision = Precision::single_precision;
  try {
    Study(*load(sample("paper")), view, {});
    FAIL();
  } catch (const InputError& error) {
    ASSERT_EQ(error.problems().size(), 3U);
    EXPECT_EQ(error.problems()[0].pointer, "/render/samples");
    EXPECT_EQ(error.problems()[1].pointer, "/render/precision");
    EXPECT_EQ(error.problems()[2].pointer, "/image");
    EXPECT_THAT(error.problems()[2].detail, testing::HasSubstr("1048576"));
  }
}

}  // namespace
}  // namespace orrery::test
