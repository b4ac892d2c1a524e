#include "server/api/error_report.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/base/number.h"

namespace orrery {

using nlohmann::ordered_json;

ordered_json error_json(const RenderStats& stats) {
  const SampledError& error = stats.error;
  const auto [low, high] = error.interval();
  return {{"rmse", error.pixel.rmse()},
          {"rmse_low", low},
          {"rmse_high", std::isfinite(high) ? ordered_json(high) : ordered_json(nullptr)},
          {"rmse_4", error.block4.rmse()},
          {"rmse_32", error.block32.rmse()},
          {"samples", error.samples},
          {"rays", stats.counts.rays.total()}};
}

std::string error_text(const RenderStats& stats) {
  const SampledError& error = stats.error;
  const auto [low, high] = error.interval();
  char text[256];
  std::snprintf(text, sizeof text, "%.4g; low=%.4g; high=%.4g; of-4=%.3g; of-32=%.3g; samples=%d; rays=%llu",
                error.pixel.rmse(), low, high, error.block4.rmse(), error.block32.rmse(), error.samples,
                static_cast<unsigned long long>(stats.counts.rays.total()));
  return text;
}

namespace {

ordered_json number_or_null(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}
std::string number_or_unknown(const std::optional<double>& value) {
  return value ? rounded(*value) : "unknown";
}

std::optional<double> known(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

constexpr const char* kReference = "technique";

}  // namespace

ordered_json bound_json(const Bound& bound) {
  return {
      {"kind", name_of(bound.kind)}, {"rms", number_or_null(bound.rms)}, {"max", number_or_null(bound.max)}};
}

ordered_json certificate_json(const Certificate& certificate) {
  ordered_json terms = ordered_json::array();
  for (const Certificate::Term& term : certificate.terms) {
    ordered_json& json =
        terms.emplace_back(ordered_json{{"subject", term.subject}, {"bound", bound_json(term.bound)}});
    if (!term.reason.empty()) json["reason"] = term.reason;
  }
  ordered_json json = {{"reference", kReference},
                       {"space", name_of(certificate.space)},
                       {"confidence", Certificate::kConfidence},
                       {"terms", std::move(terms)},
                       {"total", bound_json(certificate.total())},
                       {"known", bound_json(certificate.known())}};
  json["light"] =
      certificate.not_followed.empty() ? bound_json(certificate.total()) : bound_json(Bound::unknown());
  if (!certificate.not_followed.empty()) json["light"]["because"] = certificate.not_followed;
  if (certificate.estimate) json["estimate"] = *certificate.estimate;
  if (certificate.min_provable) json["least_provable"] = *certificate.min_provable;
  for (const Certificate::Bias& bias : certificate.biases) {
    ordered_json errors = ordered_json::array();
    for (const double error : bias.standard_error) errors.push_back(number_or_null(known(error)));
    json["biases"].push_back({{"option", bias.option},
                              {"value", bias.value},
                              {"mean", bias.mean},
                              {"standard_error", std::move(errors)}});
  }
  return json;
}

std::string bias_text(const Certificate& certificate) {
  std::string text;
  const auto add = [&](const std::array<double, 3>& channels) {
    const char* before = "=";
    for (const double value : channels) text += std::exchange(before, " ") + number_or_unknown(known(value));
  };
  for (const Certificate::Bias& bias : certificate.biases) {
    text += (text.empty() ? "" : ", ") + bias.option + "=" + number_or_unknown(bias.value) + ";mean";
    add(bias.mean);
    text += ";error";
    add(bias.standard_error);
  }
  return text;
}

std::string bound_text(const Certificate& certificate) {
  const Bound total = certificate.total();
  std::string text = "rms=" + number_or_unknown(total.rms) + ";kind=" + std::string(name_of(total.kind)) +
                     ";max=" + number_or_unknown(total.max);
  if (total.kind == Bound::Kind::unknown) {
    std::string because;
    for (const Certificate::Term& term : certificate.terms)
      if (term.bound.kind == Bound::Kind::unknown) because += (because.empty() ? "" : ", ") + term.subject;
    const Bound known = certificate.known();
    text += ";because=\"" + because + "\";known=" + number_or_unknown(known.rms) +
            ";known-kind=" + std::string(name_of(known.kind)) + ";known-max=" + number_or_unknown(known.max);
  }
  if (certificate.estimate)
    text += ";confidence=" + number_or_unknown(Certificate::kConfidence) +
            ";estimate=" + number_or_unknown(certificate.estimate);
  return text + ";reference=" + kReference + ";space=" + std::string(name_of(certificate.space));
}

ordered_json budget_json(const BudgetOutcome& outcome) {
  ordered_json json = {{"met", outcome.met()}};
  if (outcome.error > 0)
    json.update(
        {{"error", outcome.error}, {"error_met", outcome.error_met}, {"kind", name_of(outcome.kind)}});
  if (outcome.seconds > 0) json.update({{"seconds", outcome.seconds}, {"seconds_met", outcome.seconds_met}});
  json["used_s"] = outcome.used_s;
  if (outcome.error > 0) json["reachable_error"] = number_or_null(outcome.min_error);
  if (outcome.min_s) json["least_seconds"] = *outcome.min_s;
  if (!outcome.reason.empty()) json["reason"] = outcome.reason;
  return json;
}

std::string budget_text(const BudgetOutcome& outcome) {
  std::string text = outcome.met() ? "met=?1" : "met=?0";
  if (outcome.error > 0)
    text += ";error=" + number_or_unknown(outcome.error) + ";error-met=?" + (outcome.error_met ? "1" : "0") +
            ";kind=" + std::string(name_of(outcome.kind));
  if (outcome.seconds > 0)
    text += ";seconds=" + number_or_unknown(outcome.seconds) + ";seconds-met=?" +
            (outcome.seconds_met ? "1" : "0") + ";used=" + number_or_unknown(outcome.used_s);
  if (!outcome.reason.empty()) text += ";reason=\"" + outcome.reason + "\"";
  return text;
}

}  // namespace orrery
