#include "server/api/results.h"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/base/clock.h"
#include "core/math/instruction_level.h"
#include "core/model/technique.h"
#include "core/plan/plan.h"
#include "server/api/error_report.h"

namespace orrery {
namespace {

using Json = nlohmann::ordered_json;
using In = const ImageResults&;
using Row = ImageResult;
using Count = unsigned long long;

__attribute__((format(printf, 1, 2))) std::string formatted(const char* format, ...) {
  char buffer[256];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(buffer, sizeof buffer, format, arguments);
  va_end(arguments);
  return buffer;
}

// Returns the counts by depth without trailing zeros.
Json by_depth(const RayCounts::ByDepth& counts) {
  std::size_t size = counts.size();
  while (size > 0 && counts[size - 1] == 0) --size;
  return Json(std::vector<std::uint64_t>(counts.begin(), counts.begin() + static_cast<std::ptrdiff_t>(size)));
}

Json rays_by_kind(In r) {
  const RayCounts& rays = r.stats->counts.rays;
  return {{"camera", rays.camera},
          {"reflected", by_depth(rays.reflected)},
          {"refracted", by_depth(rays.refracted)},
          {"shadow", by_depth(rays.shadow)},
          {"total", rays.total()}};
}

std::string rays_table(In r) {
  const RayCounts& rays = r.stats->counts.rays;
  std::string text = formatted("%14s %14s %14s", "reflected", "refracted", "shadow");
  for (std::size_t d = 0; d < rays.shadow.size(); ++d)
    if (rays.reflected[d] + rays.refracted[d] + rays.shadow[d] > 0)
      text += formatted("\n  depth %-4zu %14llu %14llu %14llu", d, Count{rays.reflected[d]},
                        Count{rays.refracted[d]}, Count{rays.shadow[d]});
  return text + formatted("\n  %-10s %14llu\n  %-10s %14llu", "camera", Count{rays.camera}, "total",
                          Count{rays.total()});
}

// Calls visit(name, sums) for each material that rays have hit.
template <class Visit>
void for_each_energy(In r, const Visit& visit) {
  const std::vector<EnergySums>& energy = r.stats->counts.energy;
  for (std::size_t i = 0; i < energy.size(); ++i)
    if (energy[i].hits > 0) visit(r.plan->energy_of[i], energy[i]);
}

Json energy_json(In r) {
  if (r.plan->energy_of.empty()) return nullptr;
  Json rows = Json::array();
  for_each_energy(r, [&](const std::string& name, const EnergySums& sums) {
    rows.push_back({{"material", name},
                    {"hits", sums.hits},
                    {"diffuse", sums.mean(sums.diffuse)},
                    {"specular", sums.mean(sums.specular)},
                    {"transmitted", sums.mean(sums.transmitted)},
                    {"absorbed", sums.absorbed()}});
  });
  return rows;
}

std::string energy_table(In r) {
  if (r.plan->energy_of.empty()) return "";
  std::string text =
      formatted("%14s %10s %10s %11s %10s", "hits", "diffuse", "specular", "transmitted", "absorbed");
  for_each_energy(r, [&](const std::string& name, const EnergySums& sums) {
    text += formatted("\n  %-10.40s %14llu %10.6f %10.6f %11.6f %10.6f", name.c_str(), Count{sums.hits},
                      sums.mean(sums.diffuse), sums.mean(sums.specular), sums.mean(sums.transmitted),
                      sums.absorbed());
  });
  return text;
}

std::string image_line(In r) {
  return formatted("%d x %d pixels, samples per pixel: %d", r.plan->width, r.plan->height, r.plan->samples);
}

std::string method_line(In r) {
  return formatted("%s, %s%s, %s, %s, threads %d", r.plan->technique->name, r.stats->accelerator->name,
                   r.plan->reorder ? ", sorted rays" : "", precision_name(r.plan->double_precision),
                   std::string(instruction_level()).c_str(), r.cost->threads);
}

std::string structure_line(In r) {
  const AcceleratorFacts& structure = r.stats->structure;
  return formatted("%14zu bytes, depth %d, %zu references", structure.bytes, structure.depth,
                   structure.references);
}

std::string tests_line(In r) {
  const AcceleratorCounts& work = r.stats->counts.accelerator;
  return formatted("%14llu boxes, %llu primitives", Count{work.box_tests}, Count{work.primitive_tests});
}

std::string predictions_line(In r) {
  if (r.plan->prediction == Prediction::none) return "";
  const AcceleratorCounts& work = r.stats->counts.accelerator;
  const double share = 100.0 * static_cast<double>(work.verified_occluders) /
                       static_cast<double>(std::max<std::uint64_t>(1, work.predicted_occluders));
  return formatted("%14llu by %s, %llu verified (%.1f %%)", Count{work.predicted_occluders},
                   std::string(name_of(r.plan->prediction)).c_str(), Count{work.verified_occluders}, share);
}

bool has_error(In r) { return r.stats && r.stats->error.known(); }

std::string error_line(In r) {
  if (!has_error(r)) return "";
  const SampledError& error = r.stats->error;
  const auto [low, high] = error.interval();
  return formatted("%14.4g RMSE per pixel (95 %%: %.4g to %.4g), %.3g of 4x4 and %.3g of 32x32 means",
                   error.pixel.rmse(), low, high, error.block4.rmse(), error.block32.rmse());
}

std::string bound_of(In r) { return r.certificate ? bound_text(*r.certificate) : ""; }

Json bound_of_step(In r) {
  if (!r.certificate) return nullptr;
  Json json = bound_json(r.certificate->total());
  json["space"] = name_of(r.certificate->space);
  return json;
}

std::string budget_of(In r) { return r.budget ? budget_text(*r.budget) : ""; }

std::string bias_of(In r) { return r.certificate ? bias_text(*r.certificate) : ""; }

std::string warnings_of(In r) {
  std::string text;
  for (const Problem& warning : r.warnings) text += (text.empty() ? "" : "; ") + warning.text();
  return text;
}

std::string non_finite_line(In r) {
  return r.stats->non_finite_pixels > 0 ? formatted("%14llu pixels", Count{r.stats->non_finite_pixels}) : "";
}

double mrays_per_s(In r) {
  const RenderStats& stats = *r.stats;
  return stats.trace_ms > 0 ? static_cast<double>(stats.counts.rays.total()) / stats.trace_ms / 1000 : 0;
}

constexpr ResultOutputs kOnlyStats{.image = false,
                                   .refinement_part = false,
                                   .orbit_part = false,
                                   .refinement_frame = false,
                                   .orbit_frame = false,
                                   .job_step = false};

std::string text_of(const Json& json) { return json.is_null() ? "" : json.dump(); }

// Row of --stats alone.
constexpr Row of_stats(std::string_view member, Row::Json json, std::string_view label = {},
                       Row::Text line = nullptr) {
  return {.in = kOnlyStats, .member = member, .json = json, .label = label, .line = line};
}

constexpr std::array kResults{
    of_stats("", nullptr, "image", image_line),
    of_stats(
        "accelerator", [](In r) { return Json(r.stats->accelerator->name); }, "rendered by", method_line),
    of_stats("instructions", [](In) { return Json(instruction_level()); }),
    of_stats("threads", [](In r) { return Json(r.cost->threads); }),
    Row{.in = {.image = false, .orbit_part = false, .orbit_frame = false, .job_step = false, .stats = false},
        .description = "Samples per pixel so far",
        .header = "Orrery-Samples",
        .former_header = "X-Samples",
        .header_type = "integer",
        .member = "samples",
        .member_type = "integer",
        .json = [](In r) { return r.samples ? Json(*r.samples) : Json(); }},
    Row{.in = {.orbit_part = false, .job_step = false, .stats = false},
        .description = "Rays traced for this response, pass or frame",
        .header = "Orrery-Rays",
        .former_header = "X-Rays",
        .header_type = "integer",
        .member = "rays",
        .member_type = "integer",
        .json = [](In r) { return r.rays ? Json(*r.rays) : Json(); }},
    of_stats("rays", rays_by_kind, "rays", rays_table),
    of_stats("energy", energy_json, "energy", energy_table),
    of_stats(
        "structure_bytes", [](In r) { return Json(r.stats->structure.bytes); }, "structure", structure_line),
    of_stats("structure_depth", [](In r) { return Json(r.stats->structure.depth); }),
    of_stats("structure_references", [](In r) { return Json(r.stats->structure.references); }),
    of_stats(
        "node_visits", [](In r) { return Json(r.stats->counts.accelerator.node_visits); }, "visits",
        [](In r) { return formatted("%14llu nodes", Count{r.stats->counts.accelerator.node_visits}); }),
    of_stats(
        "box_tests", [](In r) { return Json(r.stats->counts.accelerator.box_tests); }, "tests", tests_line),
    of_stats("primitive_tests", [](In r) { return Json(r.stats->counts.accelerator.primitive_tests); }),
    of_stats(
        "proposals", [](In r) { return Json(r.stats->counts.accelerator.predicted_occluders); },
        "predictions", predictions_line),
    of_stats("proofs", [](In r) { return Json(r.stats->counts.accelerator.verified_occluders); }),
    of_stats(
        "cut_rays", [](In r) { return Json(r.stats->counts.cut_rays); }, "not traced",
        [](In r) { return formatted("%14llu rays", Count{r.stats->counts.cut_rays}); }),
    of_stats(
        "scatterings", [](In r) { return Json(r.stats->counts.scatterings); }, "scattered",
        [](In r) {
          const Count count{r.stats->counts.scatterings};
          return count > 0 ? formatted("%14llu events inside bodies", count) : "";
        }),
    Row{.in = {.orbit_part = false, .orbit_frame = false, .job_step = false},
        .description = "Error estimate of an image with an even number of samples. RMS error of a pixel in "
                       "linear radiance with its 95 % confidence interval; RMS errors of 4 x 4 and 32 x 32 "
                       "means; samples per pixel; total rays",
        .header = "Orrery-RMSE",
        .former_header = "X-RMSE",
        .text = [](In r) { return has_error(r) ? error_text(*r.stats) : ""; },
        .member = "error",
        .member_type = "object",
        .json = [](In r) { return has_error(r) ? error_json(*r.stats) : Json(); },
        .label = "error",
        .line = error_line},
    Row{.in = {.job_step = false},
        .description =
            "Bound on the difference from the exact result of the technique: without cuts, with "
            "infinitely many samples and exact arithmetic. rms and max are in the named space "
            "(linear radiance or display), or unknown. kind is exact, proved, estimated or "
            "unknown. If it is unknown, because lists the unknown terms, and known, known-kind and "
            "known-max bound the other terms. confidence and estimate come from the samples",
        .header = "Orrery-Error-Bound",
        .text = bound_of,
        .member = "bound",
        .stats_member = "certificate",
        .member_type = "object",
        .json = [](In r) { return r.certificate ? certificate_json(*r.certificate) : Json(); },
        .label = "error bound",
        .line = bound_of},
    Row{.in = {.image = false,
               .refinement_part = false,
               .orbit_part = false,
               .refinement_frame = false,
               .orbit_frame = false,
               .stats = false},
        .description =
            "Bound on the difference from the exact result of the technique: kind, rms, max and the "
            "space of rms and max",
        .member = "bound",
        .member_type = "object",
        .json = bound_of_step},
    Row{.in = {.refinement_part = false,
               .orbit_part = false,
               .refinement_frame = false,
               .orbit_frame = false,
               .job_step = false},
        .description = "Result of a budget: met, error, error-met, kind (of the bound that was compared with "
                       "the error), seconds, seconds-met, used and, for a "
                       "missed budget, reason",
        .header = "Orrery-Budget",
        .text = budget_of,
        .member = "budget",
        .member_type = "object",
        .json = [](In r) { return r.budget ? budget_json(*r.budget) : Json(); },
        .label = "budget",
        .line = budget_of},
    Row{.in = {.orbit_part = false},
        .description =
            "Bias of options that reduce noise. For each option: its value; the mean difference "
            "over the image from the same samples without the option, for R, G and B; the standard "
            "error of that mean as an estimate of the bias",
        .header = "Orrery-Bias",
        .former_header = "X-Bias",
        .text = bias_of,
        .label = "bias",
        .line = bias_of},
    Row{.in = {.refinement_part = false, .orbit_part = false},
        .description = "Warnings about the image, separated by semicolons. Each is a JSON Pointer and a "
                       "sentence. Absent without warnings",
        .header = "Orrery-Warning",
        .text = warnings_of},
    of_stats(
        "non_finite_pixels", [](In r) { return Json(r.stats->non_finite_pixels); }, "non-finite",
        non_finite_line),
    of_stats(
        "load_ms", [](In r) { return Json(r.cost->load_ms); }, "time",
        [](In r) { return formatted("%11.1f ms loading", r.cost->load_ms); }),
    of_stats(
        "build_ms", [](In r) { return Json(r.stats->build_ms); }, "",
        [](In r) { return formatted("%11.1f ms building", r.stats->build_ms); }),
    of_stats(
        "trace_ms", [](In r) { return Json(r.stats->trace_ms); }, "",
        [](In r) {
          return formatted("%11.1f ms tracing, %.2f million rays/s", r.stats->trace_ms, mrays_per_s(r));
        }),
    of_stats(
        "encode_ms", [](In r) { return Json(r.cost->encode_ms); }, "",
        [](In r) { return formatted("%11.1f ms encoding", r.cost->encode_ms); }),
    of_stats("mrays_per_s", [](In r) { return Json(mrays_per_s(r)); }),
    of_stats(
        "render_cpu_s", [](In r) { return Json(r.cost->render_cpu_s); }, "CPU time",
        [](In r) {
          return formatted("%12.3f s rendering, %.3f s total", r.cost->render_cpu_s, process_cpu_ms() / 1000);
        }),
    of_stats("cpu_s", [](In) { return Json(process_cpu_ms() / 1000); }),
};

}  // namespace

ImageResults results_of(const RenderResult& rendered) {
  return {.stats = &rendered.stats,
          .certificate = &rendered.certificate,
          .budget = rendered.budget ? &*rendered.budget : nullptr};
}

std::span<const ImageResult> image_results() { return kResults; }

Fields result_headers(ResultOutput output, const ImageResults& results) {
  Fields fields;
  for (const Row& row : kResults) {
    if (!(row.in.*output) || row.header.empty()) continue;
    const std::string value = row.text ? row.text(results) : text_of(row.json(results));
    if (value.empty()) continue;
    fields.emplace_back(row.header, value);
    if (!row.former_header.empty()) fields.emplace_back(row.former_header, value);
  }
  return fields;
}

std::vector<std::string_view> result_header_names(ResultOutput output) {
  std::vector<std::string_view> names;
  for (const Row& row : kResults)
    for (const std::string_view name : {row.header, row.former_header})
      if (row.in.*output && !name.empty()) names.push_back(name);
  return names;
}

Json result_members(ResultOutput output, const ImageResults& results) {
  Json members = Json::object();
  for (const Row& row : kResults) {
    if (!(row.in.*output) || row.member.empty()) continue;
    Json value = row.json(results);
    const bool renamed = output == &ResultOutputs::stats && !row.stats_member.empty();
    if (!value.is_null()) members[std::string(renamed ? row.stats_member : row.member)] = std::move(value);
  }
  return members;
}

std::string result_lines(const ImageResults& results) {
  std::string lines;
  for (const Row& row : kResults) {
    if (!row.in.stats || !row.line) continue;
    const std::string text = row.line(results);
    if (!text.empty()) lines += formatted("%-12s ", std::string(row.label).c_str()) + text + "\n";
  }
  return lines;
}

}  // namespace orrery
