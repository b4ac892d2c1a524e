#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "core/load/scene_file.h"
#include "core/plan/limits.h"
#include "core/plan/plan.h"
#include "core/study/audit.h"
#include "server/api/error_report.h"
#include "server/commands/checks.h"
#include "server/commands/commands.h"
#include "server/commands/help_layout.h"
#include "server/commands/progress.h"
#include "server/commands/render_flags.h"
#include "server/commands/signals.h"

namespace orrery {
namespace {

constexpr const char* kAuditExamples = R"(
Examples:
  orrery audit scenes/paper.json
  orrery audit scenes/glass.json --precision float --depth 3 --pixels 16384
  orrery audit scenes/cornell-box.json --samples 16 --json

Renders random pixels with the given options and with the full model: double
precision, maximum depth, no skipped rays and no clamping. Prints the difference
and a bound for the whole image, with 95 % confidence for any scene. Writes no
image. Budgets and layers are not supported.
)";

struct AuditOptions {
  bool json = false;
  int pixels = 4096, threads = 0;
  std::uint64_t draw = 0;
  RenderFlags render;
};

nlohmann::ordered_json audit_json(const Audit& found, const Plan& plan) {
  return {{"space", name_of(plan.space)},
          {"pixels", found.pixels},
          {"differing", found.differing},
          {"rms", found.rms},
          {"max", found.max},
          {"left_out", found.left_out},
          {"confidence", Certificate::kConfidence},
          {"bound", bound_json(found.bound)}};
}

std::string audit_text(const Audit& found, const Plan& plan) {
  char text[640];
  char bound[64] = "unknown: a pixel may have any error";
  if (found.bound.rms) std::snprintf(bound, sizeof bound, "%.3g RMS, 95 %%", *found.bound.rms);
  std::snprintf(text, sizeof text,
                "%-12s %d random of %d x %d, %d differ by more than %g\n"
                "%-12s %.3g RMS, %.3g maximum, in %s values; the full model omits at most %.3g\n"
                "%-12s %s\n",
                "pixels", found.pixels, plan.width, plan.height, found.differing, kEqualPixels, "difference",
                found.rms, found.max, std::string(name_of(plan.space)).c_str(), found.left_out, "bound",
                bound);
  return text;
}

int run_audit(const AuditOptions& options) {
  const RenderRequest request = read_render_flags(options.render);
  const PreparedScene scene(load_scene_file(options.render.scene));
  const SignalWatch signals;
  ThreadExecutor executor(options.threads);
  std::optional<ProgressBar> bar(std::in_place, "pixels");
  const RenderControl control{.stop = signals.interrupted(),
                              .progress = [&](int done, int total) { bar->update(done, total); }};
  const Audit found =
      with_flag_names([&] { return audit(scene, request, options.pixels, options.draw, executor, control); });
  bar.reset();
  const Plan plan = make_plan(scene.scene(), request);
  std::cout << (options.json ? audit_json(found, plan).dump(2) + "\n" : audit_text(found, plan));
  return kDone;
}

}  // namespace

Command add_audit(CLI::App& root) {
  const auto options = std::make_shared<AuditOptions>();
  CLI::App* app = root.add_subcommand("audit", "Compare random pixels of a render with the full model");
  app->footer(kAuditExamples);
  add_render_flags(*app, options->render, CommonOptions(kCommonOptions).first(3));  // without budgets
  add_threads_flag(*app, options->threads);
  app->add_option("--pixels", options->pixels,
                  with_range("Number of random pixels", 1, kMaxAuditPixels, std::to_string(options->pixels)))
      ->type_name("N")
      ->check(integer_from(1, kMaxAuditPixels))
      ->group("Audit");
  app->add_option("--draw", options->draw,
                  with_range("Seed for choosing the pixels", 0, static_cast<double>(kMaxSeed),
                             std::to_string(options->draw)))
      ->check(integer_from(0, kMaxSeed))
      ->type_name("N")
      ->group("Audit");
  app->add_flag("--json", options->json, "Print JSON")->group("Output");
  return {app, [options] { return run_audit(*options); }};
}

}  // namespace orrery
