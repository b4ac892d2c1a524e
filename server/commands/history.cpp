#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/load/scene_file.h"
#include "core/model/technique.h"
#include "core/study/history.h"
#include "core/study/picture.h"
#include "server/commands/checks.h"
#include "server/commands/commands.h"
#include "server/commands/help_layout.h"
#include "server/commands/output_file.h"
#include "server/commands/progress.h"
#include "server/commands/render_flags.h"
#include "server/commands/signals.h"
#include "server/rendering/frame.h"

namespace orrery {
namespace {

constexpr const char* kHistoryExamples = R"(
Examples:
  orrery history scenes/paper.json -o paper.svg --width 300 --height 300
  orrery history scenes/cornell-box.json -o box.json --samples 256

Renders the scene by every technique, from flat polygons to path tracing, and
compares the images with the last one. The SVG file contains the images with
their CPU times, rays, RMS differences and what they do not show. The JSON file
contains the numbers only. Budgets, layers and --view are not supported.
)";

struct HistoryOptions {
  std::string output;
  int threads = 0;
  RenderFlags render;
};

nlohmann::ordered_json history_json(const History& history) {
  nlohmann::ordered_json steps = nlohmann::ordered_json::array();
  for (const HistoryStep& step : history.steps())
    steps.push_back({{"technique", step.technique->name},
                     {"origin", step.technique->origin},
                     {"summary", step.technique->summary},
                     {"cpu_ms", step.cpu_ms},
                     {"rays", step.rays},
                     {"rms", step.rms},
                     {"largest", step.largest},
                     {"missing", step.missing}});
  return {{"scene_id", history.scene().id}, {"width", history.width()}, {"height", history.height()},
          {"samples", history.samples()},   {"space", "display"},       {"steps", std::move(steps)}};
}

void print_steps(const History& history) {
  std::printf("%-12s %-16s %10s %14s %16s\n", "technique", "origin", "CPU ms", "rays", "RMS difference");
  for (const HistoryStep& step : history.steps())
    std::printf("%-12s %-16s %10.3g %14llu %16.3g\n", step.technique->name, step.technique->origin,
                step.cpu_ms, static_cast<unsigned long long>(step.rays), step.rms);
}

int run_history(const HistoryOptions& options) {
  const std::string ending = std::filesystem::path(options.output).extension();
  if (ending != ".svg" && ending != ".json")
    throw InputError("--output", "must be a name that ends in .svg or .json (got " + options.output + ")");
  const RenderRequest request = read_render_flags(options.render);
  require_writable(options.output);
  std::optional<ProgressBar> bar(std::in_place, "pictures");
  bar->say("reading " + options.render.scene);
  const PreparedScene scene(load_scene_file(options.render.scene));
  const SignalWatch signals;
  ThreadExecutor executor(options.threads);
  History history = with_flag_names([&] { return History(scene.scene(), request); });
  for (int number = 0; number < history.pictures(); ++number) {
    history.add(render_picture(scene, history.request(number), FilmStorage::linear32, executor,
                               signals.interrupted()));
    bar->update(number + 1, history.pictures());
  }
  bar.reset();
  write_file(options.output, ending == ".svg" ? history_svg(history) : history_json(history).dump(2) + "\n");
  print_steps(history);
  return kDone;
}

}  // namespace

Command add_history(CLI::App& root) {
  const auto options = std::make_shared<HistoryOptions>();
  CLI::App* app = root.add_subcommand("history", "Render a scene by every technique and compare the images");
  app->footer(kHistoryExamples);
  app->add_option("-o,--output", options->output, "File of the comparison: .svg or .json (required)")
      ->type_name("FILE")
      ->required()
      ->group(kCommonGroup);
  add_render_flags(*app, options->render, CommonOptions(kCommonOptions).first(3));  // without budgets
  add_threads_flag(*app, options->threads);
  return {app, [options] { return run_history(*options); }};
}

}  // namespace orrery
