#include "core/study/study.h"

#include <algorithm>
#include <cassert>

#include "core/base/error.h"
#include "core/model/accelerator.h"
#include "core/model/technique.h"
#include "core/plan/limits.h"
#include "core/plan/options.h"
#include "core/plan/plan.h"
#include "core/techniques/registry.h"

namespace orrery {
namespace {

constexpr int kReferences = 2;   // pictures that make the reference
constexpr int kMoreSamples = 4;  // of the reference, than the highest configuration has
constexpr double kClockStep_ms = 1e-6;
constexpr int kStep = 4;  // from configuration to configuration
static_assert(kMostChartSamples * kMoreSamples <= kMaxSamples);

void require_chartable(const RenderRequest& view, const Plan& plan) {
  std::vector<Problem> problems;
  if (view.samples) problems.push_back({"/render/samples", "a chart varies this itself"});
  if (view.precision) problems.push_back({"/render/precision", "a chart varies this itself"});
  if (view.layers && !view.layers->empty()) problems.push_back({"/render/layers", "a chart keeps no layers"});
  const std::int64_t pixels = std::int64_t{plan.width} * plan.height;
  if (pixels > kMostChartPixels)
    problems.push_back({"/image", "expected at most " + std::to_string(kMostChartPixels) +
                                      " pixels for a chart (chart_pixels), got " + std::to_string(pixels)});
  if (!problems.empty()) throw InputError(std::move(problems));
}

// The models that are no more than the plan's, the simplest first.
std::vector<Configuration> models_up_to(const Plan& plan) {
  const Configuration whole{.technique = plan.technique->name, .max_depth = plan.max_depth};
  std::vector<Configuration> models;
  if (plan.specular && plan.technique->secondary_rays) {
    for (const TechniqueType& type : technique_types())
      if (!type.secondary_rays) models.push_back({.technique = type.name, .max_depth = 0});
    for (const int depth : {1, 2})
      if (depth < plan.max_depth) models.push_back({.technique = whole.technique, .max_depth = depth});
  }
  models.push_back(whole);
  return models;
}

bool same_work(const Point& a, const Point& b) {
  const auto configuration = [](const Point& p) {
    return std::pair(p.configuration.double_precision, p.configuration.samples);
  };
  return configuration(a) == configuration(b) && a.rays() == b.rays() && a.rmse() == b.rmse();
}

// Configurations that turned out to do what a simpler model does: the scene has no deeper rays.
void leave_out_same(std::vector<Point>& points) {
  std::vector<Point> different;
  for (Point& p : points)
    if (std::none_of(different.begin(), different.end(), [&](const Point& q) { return same_work(p, q); }))
      different.push_back(std::move(p));
  points = std::move(different);
}

}  // namespace

Study::Study(const Scene& scene, const RenderRequest& view, const Extent& extent) : view_(view) {
  require_no_budget(view, "a chart");
  require_picture(view, "a chart");
  const Plan plan = make_plan(scene, view);
  seed_ = plan.seed;
  require_chartable(view, plan);
  chart_.scene_id = scene.id;
  chart_.title = scene.title;
  chart_.width = plan.width;
  chart_.height = plan.height;
  add_configurations(plan, extent.samples);
  pictures_ = kReferences + extent.rounds * static_cast<int>(chart_.points.size());
  chart_.reference = {plan.technique->name, plan.max_depth, true,
                      chart_.points.back().configuration.samples * kMoreSamples};
}

void Study::add_configurations(const Plan& plan, int most_samples) {
  for (Configuration configuration : models_up_to(plan)) {
    for (const bool doubles : {false, true}) {
      configuration.double_precision = doubles;
      for (configuration.samples = 1; configuration.samples <= most_samples; configuration.samples *= kStep)
        chart_.points.push_back({.configuration = configuration, .rounds = {}, .accelerator = {}});
    }
  }
}

std::size_t Study::place_of(int number) const {
  return static_cast<std::size_t>(number - kReferences) % chart_.points.size();
}

RenderRequest Study::request(int number) const {
  assert(number >= 0 && number < pictures());
  const bool is_reference = number < kReferences;
  const Configuration& configuration =
      is_reference ? chart_.reference : chart_.points[place_of(number)].configuration;
  const int rounds_before = (number - kReferences) / static_cast<int>(chart_.points.size());
  const int seed_step = is_reference ? number : kReferences + rounds_before;
  RenderRequest request = view_;
  request.technique = configuration.technique;
  request.max_depth = configuration.max_depth;
  request.precision =
      configuration.double_precision ? Precision::double_precision : Precision::single_precision;
  request.samples = configuration.samples;
  request.seed = (seed_ + static_cast<std::uint64_t>(seed_step)) % (std::uint64_t{kMaxSeed} + 1);
  return request;
}

void Study::add_reference(const RenderResult& rendered) {
  const Image image = rendered.film.image(PixelFormat::linear32);
  const auto values = image.values();
  if (added_ == 0) {
    reference_.assign(values.begin(), values.end());
    return;
  }
  chart_.reference_rmse = difference(values, reference_).rmse / kReferences;
  chart_.reference_cpu_ms = rendered.stats.cpu_ms;
  for (std::size_t i = 0; i < reference_.size(); ++i)
    reference_[i] = static_cast<float>((double(reference_[i]) + double(values[i])) / kReferences);
}

void Study::add(const RenderResult& rendered) {
  assert(!complete());
  if (added_ < kReferences) {
    add_reference(rendered);
  } else {
    Point& point = chart_.points[place_of(added_)];
    point.accelerator = rendered.stats.accelerator->name;
    point.rounds.push_back(
        {.difference = difference(rendered.film.image(PixelFormat::linear32).values(), reference_),
         .cpu_ms = std::max(rendered.stats.cpu_ms, kClockStep_ms),
         .rays = double(rendered.stats.counts.rays.total())});
  }
  if (++added_ < pictures()) return;
  reference_ = {};
  leave_out_same(chart_.points);
  mark_front(chart_.points);
}

}  // namespace orrery
