#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "core/base/clock.h"
#include "core/load/scene_file.h"
#include "core/plan/plan.h"
#include "core/plan/warnings.h"
#include "server/commands/commands.h"
#include "server/commands/output_file.h"
#include "server/commands/progress.h"
#include "server/commands/render_flags.h"
#include "server/commands/signals.h"
#include "server/commands/stats.h"
#include "server/rendering/frame.h"

namespace orrery {
namespace {

constexpr const char* kRenderExamples = R"(
Examples:
  orrery render scenes/paper.json -o paper.png
  orrery render scenes/glass.json -o glass.png --width 1920 --height 1080
  orrery render scenes/paper.json -o turned.exr --azimuth 30 --elevation 10
  orrery render scenes/cornell-box.json -o box.png --error 0.02
  orrery render scenes/cornell-box.json -o box.png --seconds 2
  orrery render scenes/paper.json --stats           # statistics, no image
)";

struct RenderOptions {
  std::string stats;
  std::optional<std::string> output, certificate;
  int threads = 0;
  RenderFlags render;
};

// Returns the plan with the settings that the budget chose.
Plan made_plan(Plan plan, const std::optional<BudgetOutcome>& budget) {
  if (!budget) return plan;
  plan.asked = budget->settings;
  plan.samples = *plan.asked.samples;
  plan.min_contribution = *plan.asked.min_contribution;
  return plan;
}

RenderResult render_with_progress(const PreparedScene& scene, const Plan& plan, FileFormat format,
                                  Executor& executor, const SignalWatch& signals, Clock::time_point begin,
                                  ProgressBar& bar) {
  bar.say("preparing " + std::to_string(scene.scene().primitive_count()) + " primitives");
  return render_frame(scene, settle(scene, plan, signals.interrupted()), storage_for(format, plan), executor,
                      {.stop = signals.interrupted(),
                       .progress = [&](int done, int total) { bar.update(done, total); },
                       .used_s = [begin] { return milliseconds_since(begin) / 1000; }});
}

int render(const RenderOptions& options) {
  const auto begin = Clock::now();
  std::optional<FileFormat> kept;
  if (options.output) kept = format_of(*options.output);
  const FileFormat format = kept.value_or(FileFormat::png);
  const RenderRequest request = read_picture_flags(options.render, kept);
  if (options.output) require_writable(*options.output);
  if (options.certificate) {
    if (options.output && is_same_file(*options.certificate, *options.output))
      throw InputError("--certificate", "must differ from --output (got " + *options.certificate + ")");
    require_writable(*options.certificate);
  }
  CommandCost cost;
  auto start = Clock::now();
  std::optional<ProgressBar> bar(std::in_place, "tiles");
  bar->say("reading " + options.render.scene);
  const PreparedScene scene(load_scene_file(options.render.scene));
  cost.load_ms = milliseconds_since(start);
  const SignalWatch signals;  // until here, signals end the process
  Plan plan = make_plan(scene.scene(), request);
  ThreadExecutor executor(options.threads);
  cost.threads = executor.threads();

  const double cpu_before = process_cpu_ms();
  RenderResult result = render_with_progress(scene, plan, format, executor, signals, begin, *bar);
  bar.reset();
  cost.render_cpu_s = (process_cpu_ms() - cpu_before) / 1000;
  for (const Problem& p : find_warnings(scene.scene(), plan, result.stats.counts))
    std::cerr << "orrery: warning: " << p.text() << "\n";
  plan = made_plan(std::move(plan), result.budget);
  if (options.output) {
    start = Clock::now();
    const std::string bytes = encode_film(result.film, format);
    cost.encode_ms = milliseconds_since(start);
    if (result.budget) {
      result.budget->end_at(milliseconds_since(begin) / 1000);
      require_met(*result.budget, result.certificate);
    }
    write_file(*options.output, bytes);
  }
  if (is_missed(result.budget))
    std::cerr << "orrery: warning: budget missed: " << result.budget->reason << "\n";
  ImageResults results = results_of(result);
  results.plan = &plan;
  results.cost = &cost;
  if (options.certificate)
    write_file(*options.certificate, certificate_file_json(scene.scene(), results).dump(2) + "\n");
  if (options.stats == "json")
    std::cout << stats_json(results).dump() << "\n";
  else if (!options.stats.empty() || !options.output)
    std::cout << result_lines(results);
  return kDone;
}

}  // namespace

Command add_render(CLI::App& root) {
  const auto options = std::make_shared<RenderOptions>();
  CLI::App* app = root.add_subcommand("render", "Render a scene to an image");
  app->footer(kRenderExamples);
  app->add_option("-o,--output", options->output,
                  "Image file: .png, .jpg or .exr; without it, only statistics are printed")
      ->type_name("FILE")
      ->group(kCommonGroup);
  add_render_flags(*app, options->render);
  add_threads_flag(*app, options->threads);
  app->add_option("--certificate", options->certificate,
                  "Write the error bound as JSON, with a plan that renders the same image")
      ->type_name("FILE")
      ->group("Output");
  app->add_flag("--stats{text}", options->stats, "Print rays, times and errors, as text or JSON")
      ->check(CLI::IsMember({"text", "json"}))
      ->option_text("[=json]")
      ->group("Output");
  return {app, [options] { return render(*options); }};
}

}  // namespace orrery
