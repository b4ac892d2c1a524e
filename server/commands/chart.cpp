#include <CLI/CLI.hpp>

#include "core/plan/plan.h"
#include "core/study/study.h"
#include "server/app/chart_forms.h"
#include "server/commands/commands.h"
#include "server/commands/output_file.h"
#include "server/commands/progress.h"
#include "server/commands/render_flags.h"
#include "server/commands/scene_file.h"
#include "server/commands/signals.h"

namespace orrery {
namespace {

constexpr const char* kChartExamples = R"(
Examples:
  orrery chart scenes/glass.json -o glass.svg
  orrery chart scenes/paper.json -o paper.csv --width 300 --height 300 --chart-samples 256

Renders the scene in many ways, some rounds of each, and charts what they cost against how far they are from the
picture in double precision with four times the samples. On a busy machine times mean little; errors do.
)";

struct ChartOptions {
  std::string output;
  int threads = 0;
  Study::Extent extent;
  RenderFlags render;
};

Study study_of(const Scene& scene, const RenderRequest& view, const Study::Extent& extent) {
  try {
    return Study(scene, view, extent);
  } catch (const InputError& error) {
    throw with_flag_names(error);
  }
}

int chart(const ChartOptions& options) {
  const ChartForm* form = chart_form_of(ending_of(options.output));
  if (!form)
    throw InputError("--output", "expected a name that ends in .svg, .csv or .json, got " + options.output);
  const RenderRequest request = read_render_flags(options.render);
  require_writable(options.output);
  std::optional<ProgressBar> bar(std::in_place, "pictures");
  bar->say("reading " + options.render.scene);
  const PreparedScene scene(load_scene_file(options.render.scene));
  const SignalWatch signals;
  Study study = study_of(scene.scene(), request, options.extent);
  WorkerPool pool(options.threads);
  for (int number = 0; number < study.pictures(); ++number) {
    const SettledPlan plan =
        settle(scene, make_plan(scene.scene(), study.request(number)), signals.interrupted());
    study.add(render_frame(scene, plan, FilmStorage::linear32, pool, {.stop = signals.interrupted()}));
    bar->update(number + 1, study.pictures());
  }
  bar.reset();
  write_file(options.output, form->write(study.chart()));
  return kDone;
}

}  // namespace

Command add_chart(CLI::App& root) {
  const auto options = std::make_shared<ChartOptions>();
  CLI::App* app = root.add_subcommand("chart", "Chart speed against accuracy of a picture");
  app->footer(kChartExamples);
  app->add_option("-o,--output", options->output, "The chart; its ending chooses a drawing, a table or JSON")
      ->type_name("FILE.{svg,csv,json}")
      ->required();
  app->add_option("--chart-samples", options->extent.samples,
                  "Of the highest configuration: 1, 4, 16, ... up to it")
      ->check(CLI::Range(1, kMostChartSamples).description(""))
      ->type_name("N")
      ->capture_default_str();
  app->add_option("--rounds", options->extent.rounds, "Pictures of each configuration, with different seeds")
      ->check(CLI::Range(1, kMostChartRounds).description(""))
      ->type_name("N")
      ->capture_default_str();
  add_threads_flag(*app, options->threads);
  add_render_flags(*app, options->render);
  return {app, [options] { return chart(*options); }};
}

}  // namespace orrery
