#include "server/api/explain.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/accuracy/certificate.h"
#include "core/base/number.h"
#include "core/model/accelerator.h"
#include "core/model/technique.h"
#include "core/plan/options.h"
#include "core/plan/plan.h"
#include "core/plan/warnings.h"
#include "server/api/error_report.h"
#include "server/api/option_json.h"

namespace orrery {
namespace {

using nlohmann::ordered_json;

std::uint64_t camera_rays(const Plan& plan) {
  return std::uint64_t(plan.width) * std::uint64_t(plan.height) * std::uint64_t(plan.samples);
}

// Returns a note on the error bound, or "" if the bound is exact.
std::string bound_note(const Bound& bound) {
  if (bound.kind == Bound::Kind::exact) return "";
  char text[96];
  if (bound.kind == Bound::Kind::unknown)
    std::snprintf(text, sizeof text, " [error unknown]");
  else if (bound.max)
    std::snprintf(text, sizeof text, " [error at most %.3g, %s]", *bound.max, name_of(bound.kind).data());
  else
    std::snprintf(text, sizeof text, " [RMS error %.3g, %s]", *bound.rms, name_of(bound.kind).data());
  return text;
}

std::string padded(std::string text, std::size_t width) {
  text.resize(std::max(width, text.size()), ' ');
  return text;
}

std::string promise_text(const Certificate& certificate) {
  const Bound total = certificate.total();
  if (total.rms) return "RMS error " + rounded(*total.rms) + ", " + std::string(name_of(total.kind));
  if (certificate.estimate) return "RMS error about " + rounded(*certificate.estimate) + ", not bounded";
  return "unknown error";
}

std::string forecast_text(const Forecast& forecast) {
  const BudgetOutcome& outcome = forecast.outcome;
  const int samples = *outcome.settings.samples;
  return "about " + std::to_string(samples) + (samples == 1 ? " sample, " : " samples, ") +
         rounded(forecast.rays) + " rays and " + rounded(forecast.seconds) + " s; " +
         promise_text(forecast.certificate) +
         (outcome.met() ? "" : "; the budget would be missed: " + outcome.reason);
}

ordered_json forecast_json(const Scene& scene, const Forecast& forecast) {
  const RenderSettings& settings = forecast.outcome.settings;
  ordered_json json = {{"plan", query_of(scene, settings)},
                       {"samples", *settings.samples},
                       {"rays", std::round(forecast.rays)},
                       {"seconds", forecast.seconds},
                       {"certificate", certificate_json(forecast.certificate)}};
  if (forecast.outcome.error > 0 || forecast.outcome.seconds > 0)
    json["budget"] = budget_json(forecast.outcome);
  return json;
}

// Returns the settings that request the plan, without the options that its budget chooses.
RenderSettings requested(const Plan& plan) {
  RenderSettings settings = settings_of(plan);
  if (plan.free_samples) settings.samples.reset();
  if (plan.free_contribution) settings.min_contribution.reset();
  return settings;
}

}  // namespace

nlohmann::ordered_json explain_json(const Scene& scene, const Plan& plan,
                                    const std::optional<Forecast>& forecast) {
  const RenderSettings settings = settings_of(plan);
  ordered_json decisions = ordered_json::array();
  for (const Decision& d : plan.decisions)
    decisions.push_back(
        {{"subject", d.subject}, {"choice", d.choice}, {"reason", d.reason}, {"bound", bound_json(d.bound)}});
  ordered_json json = {{"scene",
                        {{"id", scene.id},
                         {"objects", scene.object_count},
                         {"primitives", scene.primitive_count()},
                         {"lights", scene.lights.size()}}},
                       {"image", section_json(settings, Section::image)}};
  json.update(section_json(settings, Section::render));
  json["budget"] = section_json(settings, Section::budget);
  json["stages"] = {{"direct_light", plan.direct_light},
                    {"shadows", plan.shadows},
                    {"specular", plan.specular},
                    {"filters", plan.filters}};
  if (const auto least = min_provable(plan)) json["least_provable"] = *least;
  json["camera_rays"] = camera_rays(plan);
  json["decisions"] = std::move(decisions);
  if (forecast) json["forecast"] = forecast_json(scene, *forecast);
  json["warnings"] = ordered_json::array();
  for (const Problem& p : find_warnings(scene, plan))
    json["warnings"].push_back({{"pointer", p.pointer}, {"detail", p.detail}});
  json["request"] = {{"scene_id", scene.id}};
  json["request"].update(ordered_json::parse(to_json(requested(plan))));
  return json;
}

std::string explain_text(const Scene& scene, const Plan& plan, const std::optional<Forecast>& forecast) {
  std::string text = std::to_string(plan.width) + " x " + std::to_string(plan.height) + " pixels, " +
                     (plan.free_samples ? "at most " : "") + std::to_string(plan.samples) +
                     (plan.samples == 1 ? " sample" : " samples") + " per pixel, " +
                     std::to_string(camera_rays(plan)) + " camera rays, " + plan.technique->name + "; " +
                     std::to_string(scene.object_count) +
                     (scene.object_count == 1 ? " object, " : " objects, ") +
                     std::to_string(scene.lights.size()) + (scene.lights.size() == 1 ? " light" : " lights") +
                     (scene.facts.materials.emits ? ", emissive surfaces" : "") +
                     (scene.environment && plan.technique->draws_light ? ", environment" : "") + "\n";
  std::size_t subject_width = 0, choice_width = 0;
  for (const Decision& d : plan.decisions) {
    subject_width = std::max(subject_width, d.subject.size());
    choice_width = std::max(choice_width, d.choice.size());
  }
  for (const Decision& d : plan.decisions)
    text += "  " + padded(d.subject, subject_width) + "  " + padded(d.choice, choice_width) + "  " +
            d.reason + bound_note(d.bound) + "\n";
  if (const auto least = min_provable(plan)) {
    char line[96];
    std::snprintf(line, sizeof line, "  smallest RMS error provable at this size: %.3g (%s)\n", *least,
                  name_of(plan.space).data());
    text += line;
  }
  if (forecast) text += "  forecast: " + forecast_text(*forecast) + "\n";
  for (const Problem& p : find_warnings(scene, plan)) text += "  warning: " + p.text() + "\n";
  return text;
}

}  // namespace orrery
