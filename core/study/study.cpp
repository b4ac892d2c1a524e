#include "core/study/study.h"

#include <algorithm>
#include <cassert>

#include "core/base/error.h"
#include "core/base/shorten.h"
#include "core/model/accelerator.h"
#include "core/model/technique.h"
#include "core/plan/limits.h"
#include "core/plan/options.h"
#include "core/plan/plan.h"
#include "core/study/ssim.h"
#include "core/techniques/registry.h"

namespace orrery {
namespace {

constexpr int kMoreSamples = 4;         // samples of the reference / samples of the highest configuration
constexpr int kFirstRounds = 2;         // rounds of every point; a confidence interval needs two
constexpr double kClockStep_ms = 1e-6;  // minimum CPU time of an image, so that ratios are finite
constexpr int kStep = 4;                // factor between the samples of configurations
static_assert(kMaxChartSamples * kMoreSamples <= kMaxSamples);

void require_chartable(const RenderRequest& view, const PictureSize& measured) {
  std::vector<Problem> problems;
  if (view.samples)
    problems.push_back({"/render/samples", "cannot be used with a chart (the chart varies it)"});
  if (view.precision)
    problems.push_back({"/render/precision", "cannot be used with a chart (the chart varies it)"});
  if (view.layers && !view.layers->empty())
    problems.push_back({"/render/layers", "cannot be used with a chart (a chart has no layers)"});
  const std::int64_t pixels = std::int64_t{measured.width} * measured.height;
  if (pixels > kMaxChartPixels)
    problems.push_back({"/image", "chart has " + grouped(static_cast<std::uint64_t>(pixels)) +
                                      " pixels (limit " + grouped(kMaxChartPixels) + ", chart_pixels)"});
  if (!problems.empty()) throw InputError(std::move(problems));
}

// Returns the models up to the model of the plan, simplest first: simpler techniques at their default depths,
// but at most the depth of the plan, then the technique of the plan with increasing depth.
std::vector<Configuration> models_up_to(const Plan& plan) {
  const Configuration whole{.technique = plan.technique->name, .max_depth = plan.max_depth};
  std::vector<Configuration> models;
  if (plan.specular && plan.technique->secondary_rays) {
    for (const TechniqueType& type : technique_types()) {
      if (type.name == whole.technique) break;  // later techniques model more
      const int depth = type.secondary_rays ? std::min(type.max_depth, plan.max_depth) : 0;
      models.push_back({.technique = type.name, .max_depth = depth});
    }
    for (const int depth : {1, 2, 3, 4, 6, 8, 12, 16, 24})
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

// Returns, for each point, whether the point has the same rays and error as a simpler model. This happens if
// the scene has no deeper rays.
std::vector<bool> find_same(const std::vector<Point>& points) {
  std::vector<bool> same(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i && !same[i]; ++j) same[i] = !same[j] && same_work(points[i], points[j]);
  return same;
}

}  // namespace

Study::Study(const Scene& scene, const RenderRequest& view, const Extent& extent)
    : scene_(scene), view_(view) {
  require_no_budget(view, "a chart");
  require_picture(view, "a chart");
  const Plan plan = make_plan(scene, view);
  seed_ = plan.seed;
  chart_.size = chart_.measured = {plan.width, plan.height};
  if (extent.width > 0 && extent.width < plan.width) chart_.measured = narrowed(chart_.size, extent.width);
  require_chartable(view, chart_.measured);
  view_.width = chart_.measured.width;
  view_.height = chart_.measured.height;
  chart_.scene_id = scene.id;
  chart_.title = scene.title;
  chart_.rounds = extent.rounds;
  chart_.threads = extent.threads;
  add_configurations(plan, extent.samples);
  for (int round = 0; round < extent.rounds; ++round)
    for (std::size_t i = 0; i < chart_.points.size(); ++i) turns_.push_back({i, round});
  chart_.reference = {plan.technique->name, plan.max_depth, true,
                      chart_.points.back().configuration.samples * kMoreSamples};
}

void Study::add_configurations(const Plan& plan, int max_samples) {
  for (Configuration configuration : models_up_to(plan)) {
    for (const bool doubles : {false, true}) {
      configuration.double_precision = doubles;
      for (configuration.samples = 1; configuration.samples <= max_samples; configuration.samples *= kStep)
        chart_.points.push_back({.configuration = configuration,
                                 .rounds = {},
                                 .accelerator = {},
                                 .plan = {},
                                 .picture_plan = {}});
    }
  }
}

RenderRequest Study::request(int number) const {
  assert(number >= 0 && number < pictures());
  if (number < kReferences) return request(chart_.reference, number);
  const Turn& turn = turns_[static_cast<std::size_t>(number - kReferences)];
  return request(chart_.points[turn.point].configuration, kReferences + turn.round);
}

RenderRequest Study::request(const Configuration& configuration, int seed_step) const {
  RenderRequest request = view_;
  request.technique = configuration.technique;
  request.max_depth = configuration.max_depth;
  request.precision =
      configuration.double_precision ? Precision::double_precision : Precision::single_precision;
  request.samples = configuration.samples;
  request.seed = (seed_ + static_cast<std::uint64_t>(seed_step)) % (std::uint64_t{kMaxSeed} + 1);
  return request;
}

Study::Plans Study::plans_of(const RenderRequest& request) const {
  const auto plan_at = [&](const PictureSize& size) {
    RenderRequest sized = request;
    sized.width = size.width;
    sized.height = size.height;
    return query_of(scene_, settings_of(make_plan(scene_, sized)));
  };
  return {plan_at(chart_.size), plan_at(narrowed(chart_.size, std::min(kPictureWidth, chart_.size.width)))};
}

void Study::add_reference(const RenderResult& rendered) {
  const Image image = rendered.film.image(PixelFormat::linear32);
  const auto values = image.values();
  if (added_ == 0) {
    reference_.assign(values.begin(), values.end());
    Plans plans = plans_of(request(0));
    chart_.reference_plan = std::move(plans.whole);
    chart_.reference_picture_plan = std::move(plans.picture);
    return;
  }
  chart_.reference_rmse = difference(values, reference_).rmse / kReferences;
  chart_.reference_cpu_ms = rendered.stats.cpu_ms;
  for (std::size_t i = 0; i < reference_.size(); ++i)
    reference_[i] = static_cast<float>((double(reference_[i]) + double(values[i])) / kReferences);
}

void Study::add_round(Point& point, const RenderResult& rendered) {
  if (point.rounds.empty()) {
    point.accelerator = rendered.stats.accelerator->name;
    point.certificate = rendered.certificate;
    Plans plans = plans_of(request_of(point));
    point.plan = std::move(plans.whole);
    point.picture_plan = std::move(plans.picture);
  }
  const Image image = rendered.film.image(PixelFormat::linear32);
  point.rounds.push_back({.difference = difference(image.values(), reference_),
                          .ssim = ssim(image.values(), reference_, image.width()),
                          .cpu_ms = std::max(rendered.stats.cpu_ms, kClockStep_ms),
                          .rays = double(rendered.stats.counts.rays.total())});
}

void Study::add(const RenderResult& rendered) {
  assert(!complete());
  if (added_ < kReferences) {
    add_reference(rendered);
    ++added_;
    return;
  }
  const auto taken = static_cast<std::size_t>(added_ - kReferences);
  const Turn turn = turns_[taken];
  add_round(chart_.points[turn.point], rendered);
  ++added_;
  if (taken + 1 == turns_.size() || turns_[taken + 1].round != turn.round) end_round(turn.round);
}

// Removes pending images of points that are dominated or the same as a simpler model.
void Study::end_round(int round) {
  if (round == 0) same_ = find_same(chart_.points);
  std::vector<Point> different;
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < chart_.points.size(); ++i) {
    if (same_[i]) continue;
    different.push_back(chart_.points[i]);
    numbers.push_back(i);
  }
  mark_pareto_front(different, chart_.reference_rmse);
  std::vector<bool> over = same_;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (round + 1 >= kFirstRounds && !different[i].on_front()) over[numbers[i]] = true;
  const auto next = turns_.begin() + (added_ - kReferences);
  turns_.erase(std::remove_if(next, turns_.end(), [&](const Turn& turn) { return over[turn.point]; }),
               turns_.end());
  if (!complete()) return;
  end();
  chart_.points = std::move(different);
}

}  // namespace orrery
