#include "server/commands/render_image.h"

#include <CLI/CLI.hpp>
#include <array>
#include <iostream>
#include <nlohmann/json.hpp>

#include "core/base/clock.h"
#include "core/load/scene_file.h"
#include "core/plan/plan.h"
#include "core/plan/warnings.h"
#include "server/commands/commands.h"
#include "server/commands/output_file.h"
#include "server/commands/progress.h"
#include "server/commands/signals.h"
#include "server/commands/stats.h"
#include "server/rendering/frame.h"

namespace orrery {
namespace {

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

}  // namespace

int render_image(const RenderOptions& options, const LoadScene& load) {
  const auto begin = Clock::now();
  std::optional<FileFormat> kept;
  if (options.output) kept = format_of(*options.output, options.format);
  const FileFormat format = kept.value_or(FileFormat::png);
  RenderRequest request = read_picture_flags(options.render, kept);
  if (options.complete) request = options.complete(std::move(request));
  if (options.output == "-" && !options.stats.empty())
    throw InputError("--stats", "cannot be used with --output -, because both print to standard output");
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
  const PreparedScene scene(load(request));
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

void add_output_flags(CLI::App& app, RenderOptions& options) {
  app.add_option("-o,--output", options.output,
                 "Image file: .png, .jpg or .exr, or - for standard output; without it, only statistics are "
                 "printed")
      ->type_name("FILE")
      ->group(kCommonGroup);
  app.add_option("--format", options.format, "Format: png, jpeg or exr; default: by the name, png for -")
      ->check(CLI::IsMember({"png", "jpeg", "exr"}))
      ->option_text("NAME")
      ->group("Output");
  app.add_option("--certificate", options.certificate,
                 "Write the error bound as JSON, with a plan that renders the same image")
      ->type_name("FILE")
      ->group("Output");
  app.add_flag("--stats{text}", options.stats, "Print rays, times and errors, as text or JSON")
      ->check(CLI::IsMember({"text", "json"}))
      ->option_text("[=json]")
      ->group("Output");
}

}  // namespace orrery
