#include "core/study/study.h"

#include <gmock/gmock.h>

#include <functional>
#include <iostream>
#include <set>
#include <sstream>

#include "core/base/error.h"
#include "core/load/load.h"
#include "core/params/json.h"
#include "core/plan/limits.h"
#include "core/plan/options.h"
#include "tests/support/covers.h"
#include "tests/support/pictures.h"

// Tests the configurations of a study and their measurement.
namespace orrery::test {
namespace {

RenderResult made(const PreparedScene& scene, const RenderRequest& request) {
  return render_frame(scene, settle(scene, make_plan(scene.scene(), request)), FilmStorage::linear32,
                      shared_executor());
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

// Returns the chart as chart_of() does, with times from `cpu_ms`.
Chart chart_of_times(Study& study, const PreparedScene& scene,
                     const std::function<double(const RenderRequest&, const RenderStats&)>& cpu_ms) {
  for (int number = 0; number < study.pictures(); ++number) {
    const RenderRequest request = study.request(number);
    RenderResult result = made(scene, request);
    result.stats.cpu_ms = cpu_ms(request, result.stats);
    study.add(result);
  }
  return study.chart();
}

// Returns a time proportional to the ray count, doubled in double precision.
double ms_by_rays(const RenderRequest& request, const RenderStats& stats) {
  return 1e-4 * double(stats.counts.rays.total()) *
         (*request.precision == Precision::double_precision ? 2 : 1);
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

TEST(Study, SkipsModelsUnneededByScene) {
  const auto glass = load(sample("glass"));
  EXPECT_THAT(lines_of(Study(*glass, {}, {}).chart()),
              testing::ElementsAre("raycast 0", "raycast 0, double", "whitted 1", "whitted 1, double",
                                   "whitted 2", "whitted 2, double", "whitted 3", "whitted 3, double",
                                   "whitted 4", "whitted 4, double", "whitted 6", "whitted 6, double",
                                   "whitted 8", "whitted 8, double", "whitted 12", "whitted 12, double"));
  RenderRequest shallow;
  shallow.max_depth = 1;
  EXPECT_THAT(lines_of(Study(*glass, shallow, {}).chart()),
              testing::ElementsAre("raycast 0", "raycast 0, double", "whitted 1", "whitted 1, double"));
  const auto rough = load(scene_of("{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}"));
  EXPECT_EQ(lines_of(Study(*rough, {}, {}).chart()).size(), 2U);
}

TEST(Study, TriesAllSimplerTechniques) {
  const auto names = [](const char* technique) {
    RenderRequest view;
    view.technique = technique;
    view.max_depth = 2;
    std::vector<std::string> floats;
    for (const std::string& name : lines_of(Study(*load(sample("cornell-box")), view, {}).chart()))
      if (!name.ends_with("double")) floats.push_back(name);
    return floats;
  };
  using testing::ElementsAre;
  EXPECT_THAT(names("distributed"), ElementsAre("raycast 0", "whitted 2", "distributed 1", "distributed 2"));
  EXPECT_THAT(names("path"), ElementsAre("raycast 0", "whitted 2", "distributed 2", "path 1", "path 2"));
}

TEST(Study, ComparesSimplerTechniquesWithPaths) {
  RenderRequest view = size(24, 24);
  view.max_depth = 4;
  const Chart chart = chart_of(sample("cornell-box"), view, {.samples = 16, .rounds = 2});
  EXPECT_EQ(chart.reference.technique, "path");
  EXPECT_EQ(find(chart, {"path", 4, true, 16}).configuration.samples, 16);
  EXPECT_LT(find(chart, {"path", 4, false, 16}).rmse(), find(chart, {"path", 4, false, 1}).rmse() / 2);
  EXPECT_GT(find(chart, {"distributed", 4, false, 16}).rmse(),
            0.9 * find(chart, {"distributed", 4, false, 4}).rmse())
      << "more samples do not reduce the model error";
}

TEST(Study, DropsEquivalentConfigurations) {
  const Chart chart = chart_of(sample("flag"), size(24, 24), {.samples = 4, .rounds = 1});
  EXPECT_THAT(lines_of(chart),
              testing::ElementsAre("raycast 0", "raycast 0, double", "whitted 1", "whitted 1, double"));
  EXPECT_EQ(chart.reference.max_depth, 5);
}

TEST(Study, CyclesConfigurationsWithNewSeedPerRound) {
  RenderRequest view = size(30, 20);
  view.seed = kMaxSeed - 1;
  view.max_depth = 1;
  const auto scene = load(sample("glass"));
  const Study study(*scene, view, {.samples = 20, .rounds = 2});
  constexpr int kConfigurations = 2 * 2 * 3;  // models, precisions, and 1, 4, 16 samples
  EXPECT_EQ(study.pictures(), 2 + 2 * kConfigurations);
  for (const int number : {0, 1}) {
    EXPECT_EQ(study.request(number).samples, 64);
    EXPECT_EQ(study.request(number).precision, Precision::double_precision);
  }
  EXPECT_EQ(study.request(2).technique, "raycast");
  EXPECT_EQ(study.request(4).samples, 16);
  EXPECT_EQ(study.request(2 + kConfigurations).technique, "raycast");
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

TEST(Study, SpendsRoundsOnFrontCandidates) {
  const PreparedScene scene(load(sample("glass")));
  RenderRequest view = size(24, 24);
  view.max_depth = 1;
  constexpr int kMost = 6;
  Study study(scene.scene(), view, {.samples = 4, .rounds = kMost});
  const int planned = study.pictures();
  // Double takes twice as long, so that float dominates it.
  const Chart chart = chart_of_times(study, scene, [](const RenderRequest& request, const RenderStats&) {
    return *request.samples * (*request.precision == Precision::double_precision ? 2.0 : 1.0) *
           (*request.max_depth + 1.0);
  });
  EXPECT_LT(study.pictures(), planned);
  int rounds = 0;
  for (const Point& p : chart.points) {
    EXPECT_EQ(p.rounds.size(), p.on_front() ? std::size_t{kMost} : 2U) << line_name(p.configuration);
    EXPECT_EQ(p.on_front(), !p.configuration.double_precision);
    rounds += static_cast<int>(p.rounds.size());
  }
  EXPECT_EQ(study.pictures(), 2 + rounds);
  EXPECT_EQ(chart.rounds, kMost);
}

TEST(Study, MeasuresAllRoundsOfUndecidedPoints) {
  const PreparedScene scene(load(sample("glass")));
  RenderRequest view = size(24, 24);
  view.max_depth = 1;
  Study study(scene.scene(), view, {.samples = 1, .rounds = 4});
  // The ranking of the points by speed alternates with the seed.
  const Chart chart = chart_of_times(study, scene, [](const RenderRequest& request, const RenderStats&) {
    const double order = *request.max_depth + 2.0 * (*request.precision == Precision::double_precision);
    return *request.seed % 2 == 0 ? 5 + order : 5 - order;
  });
  for (const Point& p : chart.points) {
    EXPECT_EQ(p.rounds.size(), 4U);
    EXPECT_NE(p.pareto_status, ParetoStatus::dominated);
  }
}

RenderRequest request_of(const std::string& plan) {
  Json request = Json::object();
  std::istringstream pairs(plan);
  for (std::string pair; std::getline(pairs, pair, '&');) {
    const std::string key = pair.substr(0, pair.find('=')), text = pair.substr(pair.find('=') + 1);
    for (const RenderOption& option : render_options()) {
      if (option.key != key) continue;
      const bool number = option.form() == RenderOption::Form::number;
      request[std::string(name_of(option.section))][key] = number ? Json::parse(text) : Json(text);
    }
  }
  return read_request(document_of(std::move(request)));
}

double rmse_of(const Picture& picture, const std::vector<double>& reference) {
  std::vector<double> values;
  for (const Vec3f& pixel : picture.pixels)
    for (const float value : {pixel.x, pixel.y, pixel.z}) values.push_back(value);
  return rms_difference(values, reference);
}

struct ChartedScene {
  std::shared_ptr<const Scene> scene;
  Chart chart;
  std::vector<double> reference;
};

ChartedScene charted(const char* name, int rounds) {
  ChartedScene made;
  made.scene = load(sample(name));
  RenderRequest view = size(24, 24);
  view.azimuth_degrees = 10;
  Study study(*made.scene, view, {.samples = 16, .rounds = rounds});
  made.chart = chart_of_times(study, PreparedScene(made.scene), ms_by_rays);
  Study again(*made.scene, view, {.samples = 16, .rounds = rounds});
  for (const int number : {0, 1}) {
    const Picture half = render(made.scene, again.request(number));
    made.reference.resize(3 * half.pixels.size());
    for (std::size_t i = 0; i < half.pixels.size(); ++i) {
      made.reference[3 * i] += double(half.pixels[i].x) / 2;
      made.reference[3 * i + 1] += double(half.pixels[i].y) / 2;
      made.reference[3 * i + 2] += double(half.pixels[i].z) / 2;
    }
  }
  return made;
}

TEST(Study, ReproducesImageFromPlanOfPoint) {
  for (const char* name : {"glass", "cornell-box", "flag"}) {
    const ChartedScene made = charted(name, 1);
    for (const Point& p : made.chart.points) {
      EXPECT_EQ(p.plan, p.picture_plan) << "these images need no reduction";
      const Picture picture = render(made.scene, request_of(p.plan));
      EXPECT_NEAR(rmse_of(picture, made.reference), p.rmse(), 1e-6) << name << " " << p.plan;
      EXPECT_EQ(double(picture.stats.counts.rays.total()), p.rays());
      EXPECT_EQ(p.accelerator, picture.stats.accelerator->name);
    }
  }
}

TEST(Study, MeasuresReducedImages) {
  const auto scene = load(sample("glass"));
  const Study study(*scene, size(1000, 750), {.samples = 1, .rounds = 1, .width = 80});
  EXPECT_EQ(study.request(2).width, 80);
  EXPECT_EQ(study.request(2).height, 60);
  EXPECT_EQ(study.chart().size.width, 1000);
  const PreparedScene prepared(scene);
  RenderRequest view = size(1000, 750);
  view.max_depth = 1;
  Study whole(*scene, view, {.samples = 1, .rounds = 1, .width = 40});
  const Chart chart =
      chart_of_times(whole, prepared, [](const RenderRequest&, const RenderStats&) { return 3.0; });
  EXPECT_EQ(*request_of(chart.points[0].plan).width, 1000);
  EXPECT_EQ(*request_of(chart.points[0].picture_plan).width, kPictureWidth);
  EXPECT_EQ(*request_of(chart.points[0].picture_plan).height, 240);
  EXPECT_EQ(*resolve(*scene, request_of(chart.reference_picture_plan)).samples, 4);
  EXPECT_EQ(Study(*scene, size(80, 60), {.width = 900}).chart().measured.width, 80);
}

// Renders points of several charts from their plans with 24 new seeds. The mean error must be inside the
// interval from the chart's four rounds, for at least 28 of 30 points.
TEST(Study, CoversErrorsOfOtherSeedsInIntervals) {
  test::covers("certificate-39");
  constexpr int kSeeds = 24;
  int points = 0, inside = 0;
  for (const char* name : {"glass", "cornell-box", "mirrors", "paper"}) {
    const ChartedScene made = charted(name, 4);
    for (const std::size_t i : made.chart.front()) {
      const Point& p = made.chart.points[i];
      const Interval interval = *p.rmse_interval();
      double sum = 0;
      for (int seed = 0; seed < kSeeds; ++seed) {
        RenderRequest request = request_of(p.plan);
        request.seed = static_cast<std::uint64_t>(1000 + seed);
        sum += rmse_of(render(made.scene, request), made.reference);
      }
      ++points;
      constexpr double kRounding = 1e-7;  // float error of the reference
      inside += interval.low - kRounding <= sum / kSeeds && sum / kSeeds <= interval.high + kRounding;
    }
  }
  std::cout << inside << " of " << points << " points inside their intervals\n";
  EXPECT_GE(points, 20);
  EXPECT_GE(inside * 30, points * 28);
}

TEST(Study, SortsFrontByCostWithoutDominatedPoints) {
  const Chart chart = chart_of(sample("glass"), size(32, 32), {.samples = 16, .rounds = 4});
  const auto front = chart.front();
  ASSERT_FALSE(front.empty());
  EXPECT_TRUE(std::is_sorted(front.begin(), front.end(), [&](std::size_t a, std::size_t b) {
    return chart.points[a].cpu_ms() < chart.points[b].cpu_ms();
  }));
  for (const std::size_t i : front)
    for (const Point& other : chart.points) {
      const Point& member = chart.points[i];
      EXPECT_FALSE(other.rmse_interval()->high < member.rmse_interval()->low &&
                   other.cpu_ms_interval()->high < member.cpu_ms_interval()->low)
          << line_name(member.configuration) << " by " << line_name(other.configuration);
    }
}

TEST(Study, ConvergesToModelError) {
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

TEST(Study, MatchesIndependentMeasurement) {
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

TEST(Study, RejectsVariedSettingsAndLargeImages) {
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
    EXPECT_THAT(error.problems()[2].detail, testing::HasSubstr("1,048,576"));
  }
}

}  // namespace
}  // namespace orrery::test
