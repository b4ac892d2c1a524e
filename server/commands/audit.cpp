#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "core/plan/limits.h"
#include "core/plan/plan.h"
#include "core/study/audit.h"
#include "server/app/error_report.h"
#include "server/commands/commands.h"
#include "server/commands/progress.h"
#include "server/commands/render_flags.h"
#include "server/commands/scene_file.h"
#include "server/commands/signals.h"

namespace orrery {
namespace {

constexpr const char* kAuditExamples = R"(
Examples:
  orrery audit scenes/paper.json
  orrery audit scenes/glass.json --precision float --depth 3 --pixels 16384
  orrery audit scenes/cornell-box.json --samples 16 --json

Writes no picture. Renders pixels that are drawn at random once as asked and once by the whole model: in double
precision, to the greatest depth, with nothing cut. Says how far they differ, and how far the whole picture does at
most, with 95 % confidence and whatever the scene.
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
  char bound[64] = "unknown: nothing limits how far one pixel may be off";
  if (found.bound.rms) std::snprintf(bound, sizeof bound, "%.3g RMS, 95 %%", *found.bound.rms);
  std::snprintf(text, sizeof text,
                "%-12s %d drawn of %d x %d, of which %d differ by more than %g\n"
                "%-12s %.3g RMS, %.3g at most, of %s values; the whole model leaves out %.3g at most\n"
                "%-12s %s\n",
                "pixels", found.pixels, plan.width, plan.height, found.differing, kEqualPixels, "difference",
                found.rms, found.max, std::string(name_of(plan.space)).c_str(), found.left_out, "bound",
                bound);
  return text;
}

Audit audit_of(const PreparedScene& scene, const AuditOptions& options, const RenderRequest& request,
               WorkerPool& pool, const RenderControl& control) {
  try {
    return audit(scene, request, options.pixels, options.draw, pool, control);
  } catch (const InputError& error) {
    throw with_flag_names(error);
  }
}

int run_audit(const AuditOptions& options) {
  const RenderRequest request = read_render_flags(options.render);
  const PreparedScene scene(load_scene_file(options.render.scene));
  const SignalWatch signals;
  WorkerPool pool(options.threads);
  std::optional<ProgressBar> bar(std::in_place, "pixels");
  const Audit found = audit_of(
      scene, options, request, pool,
      {.stop = signals.interrupted(), .progress = [&](int done, int total) { bar->update(done, total); }});
  bar.reset();
  const Plan plan = make_plan(scene.scene(), request);
  std::cout << (options.json ? audit_json(found, plan).dump(2) + "\n" : audit_text(found, plan));
  return kDone;
}

}  // namespace

Command add_audit(CLI::App& root) {
  const auto options = std::make_shared<AuditOptions>();
  CLI::App* app = root.add_subcommand("audit", "Hold some pixels of a render against the whole model");
  app->footer(kAuditExamples);
  app->add_option("--pixels", options->pixels, "How many are drawn")
      ->type_name("N")
      ->check(CLI::Range(1, kMaxAuditPixels).description(""))
      ->capture_default_str();
  app->add_option("--draw", options->draw, "Seed of the drawing")
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{kMaxSeed}).description(""))
      ->type_name("N")
      ->capture_default_str();
  app->add_flag("--json", options->json, "Print JSON");
  add_threads_flag(*app, options->threads);
  add_render_flags(*app, options->render);
  return {app, [options] { return run_audit(*options); }};
}

}  // namespace orrery
