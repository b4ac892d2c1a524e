#include "server/commands/stats.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/base/clock.h"
#include "core/base/version.h"
#include "core/math/instruction_level.h"
#include "core/model/technique.h"
#include "core/plan/plan.h"
#include "server/api/error_report.h"
#include "server/api/option_json.h"
#include "server/api/render_options.h"

namespace orrery {
namespace {

using nlohmann::ordered_json;

// Returns the counts by depth without trailing zeros.
ordered_json by_depth(const RayCounts::ByDepth& counts) {
  std::size_t size = counts.size();
  while (size > 0 && counts[size - 1] == 0) --size;
  return ordered_json(
      std::vector<std::uint64_t>(counts.begin(), counts.begin() + static_cast<std::ptrdiff_t>(size)));
}

double mrays_per_s(const RenderStats& stats) {
  return stats.trace_ms > 0 ? static_cast<double>(stats.counts.rays.total()) / stats.trace_ms / 1000 : 0;
}

__attribute__((format(printf, 2, 3))) void line(std::string& text, const char* format, ...) {
  char buffer[256];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(buffer, sizeof buffer, format, arguments);
  va_end(arguments);
  text += buffer;
  text += '\n';
}

void rays_text(std::string& text, const RayCounts& rays) {
  line(text, "%-12s %14s %14s %14s", "rays", "reflected", "refracted", "shadow");
  for (std::size_t d = 0; d < rays.shadow.size(); ++d) {
    if (rays.reflected[d] + rays.refracted[d] + rays.shadow[d] == 0) continue;
    line(text, "  depth %-4zu %14llu %14llu %14llu", d, static_cast<unsigned long long>(rays.reflected[d]),
         static_cast<unsigned long long>(rays.refracted[d]), static_cast<unsigned long long>(rays.shadow[d]));
  }
  line(text, "  %-10s %14llu", "camera", static_cast<unsigned long long>(rays.camera));
  line(text, "  %-10s %14llu", "total", static_cast<unsigned long long>(rays.total()));
}

void prediction_text(std::string& text, const Plan& plan, const TraceCounts& counts) {
  const std::uint64_t predicted_occluders = counts.accelerator.predicted_occluders,
                      verified_occluders = counts.accelerator.verified_occluders;
  const double share = 100.0 * static_cast<double>(verified_occluders) /
                       static_cast<double>(std::max<std::uint64_t>(1, predicted_occluders));
  line(text, "%-12s %14llu by %s, %llu verified (%.1f %%)", "predictions",
       static_cast<unsigned long long>(predicted_occluders), std::string(name_of(plan.prediction)).c_str(),
       static_cast<unsigned long long>(verified_occluders), share);
}

}  // namespace

ordered_json stats_json(const Plan& plan, const RunStats& stats) {
  const TraceCounts& counts = stats.render.counts;
  ordered_json json = options_json(settings_of(plan));
  json["accelerator"] = stats.render.accelerator->name;  // chosen by the render
  const ordered_json measured = {{"instructions", instruction_level()},
                                 {"threads", stats.threads},
                                 {"rays",
                                  {{"camera", counts.rays.camera},
                                   {"reflected", by_depth(counts.rays.reflected)},
                                   {"refracted", by_depth(counts.rays.refracted)},
                                   {"shadow", by_depth(counts.rays.shadow)},
                                   {"total", counts.rays.total()}}},
                                 {"structure_bytes", stats.render.structure.bytes},
                                 {"structure_depth", stats.render.structure.depth},
                                 {"structure_references", stats.render.structure.references},
                                 {"node_visits", counts.accelerator.node_visits},
                                 {"box_tests", counts.accelerator.box_tests},
                                 {"primitive_tests", counts.accelerator.primitive_tests},
                                 {"proposals", counts.accelerator.predicted_occluders},
                                 {"proofs", counts.accelerator.verified_occluders},
                                 {"cut_rays", counts.cut_rays},
                                 {"non_finite_pixels", stats.render.non_finite_pixels},
                                 {"load_ms", stats.load_ms},
                                 {"build_ms", stats.render.build_ms},
                                 {"trace_ms", stats.render.trace_ms},
                                 {"encode_ms", stats.encode_ms},
                                 {"mrays_per_s", mrays_per_s(stats.render)},
                                 {"render_cpu_s", stats.render_cpu_s},
                                 {"cpu_s", process_cpu_ms() / 1000}};
  json.update(measured);
  if (stats.render.error.known()) json["error"] = error_json(stats.render);
  json["certificate"] = certificate_json(stats.certificate);
  if (stats.budget) json["budget"] = budget_json(*stats.budget);
  return json;
}

ordered_json certificate_file_json(const Scene& scene, const Plan& plan, const RunStats& stats) {
  ordered_json json = {{"version", 1},
                       {"scene", scene.id},
                       {"plan", query_of(scene, settings_of(plan))},
                       {"certificate", certificate_json(stats.certificate)},
                       {"cost", {{"rays", stats.render.counts.rays.total()}, {"cpu_s", stats.render_cpu_s}}}};
  if (stats.budget) json["budget"] = budget_json(*stats.budget);
  return json;
}

std::string stats_text(const Plan& plan, const RunStats& stats) {
  const TraceCounts& counts = stats.render.counts;
  std::string text;
  line(text, "%-12s %d x %d pixels, samples per pixel: %d", "image", plan.width, plan.height, plan.samples);
  line(text, "%-12s %s, %s%s, %s, %s, threads %d", "rendered by", plan.technique->name,
       stats.render.accelerator->name, plan.reorder ? ", sorted rays" : "",
       precision_name(plan.double_precision), std::string(instruction_level()).c_str(), stats.threads);
  rays_text(text, counts.rays);
  const AcceleratorFacts& structure = stats.render.structure;
  line(text, "%-12s %14zu bytes, depth %d, %zu references", "structure", structure.bytes, structure.depth,
       structure.references);
  line(text, "%-12s %14llu nodes", "visits", static_cast<unsigned long long>(counts.accelerator.node_visits));
  line(text, "%-12s %14llu boxes, %llu primitives", "tests",
       static_cast<unsigned long long>(counts.accelerator.box_tests),
       static_cast<unsigned long long>(counts.accelerator.primitive_tests));
  if (plan.prediction != Prediction::none) prediction_text(text, plan, counts);
  line(text, "%-12s %14llu rays", "not traced", static_cast<unsigned long long>(counts.cut_rays));
  if (const SampledError& error = stats.render.error; error.known()) {
    const auto [low, high] = error.interval();
    line(text, "%-12s %14.4g RMSE per pixel (95 %%: %.4g to %.4g), %.3g of 4x4 and %.3g of 32x32 means",
         "error", error.pixel.rmse(), low, high, error.block4.rmse(), error.block32.rmse());
  }
  line(text, "%-12s %s", "error bound", bound_text(stats.certificate).c_str());
  if (stats.budget) line(text, "%-12s %s", "budget", budget_text(*stats.budget).c_str());
  if (!stats.certificate.biases.empty()) line(text, "%-12s %s", "bias", bias_text(stats.certificate).c_str());
  if (stats.render.non_finite_pixels > 0)
    line(text, "%-12s %14llu pixels", "non-finite",
         static_cast<unsigned long long>(stats.render.non_finite_pixels));
  line(text, "%-12s %11.1f ms loading", "time", stats.load_ms);
  line(text, "%-12s %11.1f ms building", "", stats.render.build_ms);
  line(text, "%-12s %11.1f ms tracing, %.2f million rays/s", "", stats.render.trace_ms,
       mrays_per_s(stats.render));
  line(text, "%-12s %11.1f ms encoding", "", stats.encode_ms);
  line(text, "%-12s %12.3f s rendering, %.3f s total", "CPU time", stats.render_cpu_s,
       process_cpu_ms() / 1000);
  return text;
}

}  // namespace orrery
