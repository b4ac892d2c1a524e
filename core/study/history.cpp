#include "core/study/history.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/base/error.h"
#include "core/base/shorten.h"
#include "core/image/srgb.h"
#include "core/plan/limits.h"
#include "core/plan/options.h"
#include "core/plan/plan.h"
#include "core/render/views.h"
#include "core/techniques/registry.h"

namespace orrery {
namespace {

// Returns all techniques: those that rasterize were published first, in the order of the registry, except
// that ray casting (1968) follows them because it models more.
std::vector<const TechniqueType*> techniques_in_order() {
  std::vector<const TechniqueType*> all;
  for (const TechniqueType& type : technique_types()) all.push_back(&type);
  std::stable_partition(all.begin(), all.end(), [](const TechniqueType* t) { return t->rasterizes; });
  return all;
}

void require_comparable(const RenderRequest& view, const Plan& plan) {
  std::vector<Problem> problems;
  if (view.technique)
    problems.push_back({"/render/technique", "cannot be used with a history (it renders by all techniques)"});
  if (view.layers && !view.layers->empty())
    problems.push_back({"/render/layers", "cannot be used with a history (a history has no layers)"});
  const std::int64_t pixels = std::int64_t{plan.width} * plan.height;
  if (pixels > kMaxHistoryPixels)
    problems.push_back({"/image", "history has " + grouped(static_cast<std::uint64_t>(pixels)) +
                                      " pixels (limit " + grouped(kMaxHistoryPixels) + ", history_pixels)"});
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace

History::History(const Scene& scene, const RenderRequest& view) : scene_(scene), view_(view) {
  require_no_budget(view, "a history");
  require_picture(view, "a history");
  view_.samples = view.samples.value_or(kHistorySamples);
  for (const TechniqueType* technique : techniques_in_order()) {
    if (technique->rasterizes && scene.camera->all_around()) continue;
    steps_.push_back({.technique = technique, .missing = {}});
    const Plan plan = make_plan(scene, request(pictures() - 1));
    if (steps_.size() == 1) require_comparable(view, plan);
    width_ = plan.width;
    height_ = plan.height;
    steps_.back().missing = plan.not_followed;
    if (scene.facts.materials.emits && !technique->draws_light)
      steps_.back().missing.push_back("the light of lamps");
  }
}

RenderRequest History::request(int number) const {
  RenderRequest request = view_;
  request.technique = steps_[static_cast<std::size_t>(number)].technique->name;
  return request;
}

void History::add(const RenderResult& rendered) {
  assert(!complete());
  HistoryStep& step = steps_[images_.size()];
  step.cpu_ms = rendered.stats.cpu_ms;
  step.rays = step.technique->rasterizes ? 0 : rendered.stats.counts.rays.total();
  std::vector<float>& image = images_.emplace_back();
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const Vec3f linear = rendered.film.stored().linear(x, y);
      for (std::size_t c = 0; c < 3; ++c)
        image.push_back(static_cast<float>(encode_srgb(std::clamp(double(linear[c]), 0.0, 1.0))));
    }
  pngs_.push_back(encode_film(rendered.film, FileFormat::png));
  if (complete()) compare_with_last();
}

void History::compare_with_last() {
  const std::vector<float>& last = images_.back();
  for (std::size_t s = 0; s < steps_.size(); ++s) {
    double squares = 0, largest = 0;
    for (std::size_t i = 0; i < last.size(); ++i) {
      const double off = std::abs(double(images_[s][i]) - last[i]);
      squares += off * off;
      largest = std::max(largest, off);
    }
    steps_[s].rms = std::sqrt(squares / static_cast<double>(last.size()));
    steps_[s].largest = largest;
  }
}

std::string missing_sentence(const HistoryStep& step) {
  if (step.missing.empty()) return "Shows all light of the scene, with noise.";
  std::string text = "Does not show ";
  for (std::size_t i = 0; i < step.missing.size(); ++i) {
    if (i > 0) text += i + 1 == step.missing.size() ? " or " : ", ";
    text += step.missing[i];
  }
  return text + ".";
}

}  // namespace orrery
