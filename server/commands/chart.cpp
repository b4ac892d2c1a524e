#include <CLI/CLI.hpp>
#include <filesystem>

#include "core/load/scene_file.h"
#include "core/plan/limits.h"
#include "core/study/picture.h"
#include "core/study/study.h"
#include "server/api/chart_forms.h"
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

constexpr const char* kChartExamples = R"(
Examples:
  orrery chart scenes/glass.json -o glass.svg --chart-width 200
  orrery chart scenes/paper.json -o paper.csv --width 300 --height 300
  orrery chart scenes/cornell-box.json -o box.json --pictures box/

Renders the scene in many configurations and plots CPU time against error. The
reference has double precision and four times the samples. Prints the cheapest
options for several errors. Other programs that use the CPU distort the times,
but not the errors. --samples and --precision are not supported, because the
chart varies them. Budgets, layers and --view are not supported either.
)";

struct ChartOptions {
  std::string output, pictures;
  int threads = 0;
  Study::Extent extent;
  RenderFlags render;
};

// Returns a name such as "2-whitted-5-float-16.png". `place`: rank by cost, from 0.
std::string picture_name(std::size_t place, const Configuration& c) {
  return std::to_string(place) + "-" + c.technique + "-" + std::to_string(c.max_depth) + "-" +
         precision_name(c.double_precision) + "-" + std::to_string(c.samples) + ".png";
}

// Renders the Pareto front again with the seeds of the first round, and writes the images.
void write_pictures(const std::string& folder, const Study& study, const PreparedScene& scene,
                    Executor& executor, const SignalWatch& signals) {
  const std::vector<std::size_t> front = study.chart().front();
  for (std::size_t place = 0; place < front.size(); ++place) {
    const Point& point = study.chart().points[front[place]];
    const RenderResult made =
        render_picture(scene, study.request_of(point), FilmStorage::srgb8, executor, signals.interrupted());
    write_file((std::filesystem::path(folder) / picture_name(place, point.configuration)).string(),
               encode_film(made.film, FileFormat::png));
  }
}

void print_recommendations(const Chart& chart) {
  std::printf(
      "RMS error (linear), predicted time on %d threads at %d x %d pixels (95 %% interval), options:\n",
      chart.threads, chart.size.width, chart.size.height);
  for (const Recommendation& r : recommendations(chart)) {
    const Point& point = chart.points[r.point];
    const auto ms = [&](double cpu_ms) { return 1000 * chart.full_seconds(cpu_ms); };
    const auto interval = point.cpu_ms_interval();
    char span[64] = "one round";
    if (interval) std::snprintf(span, sizeof span, "%.3g to %.3g", ms(interval->low), ms(interval->high));
    std::printf("error < %-7g %9.3g ms (%s)  %s\n", r.error, ms(point.cpu_ms()), span,
                flags_of_plan(point.plan).c_str());
  }
}

int chart(ChartOptions options) {
  const ChartForm* form = chart_form_of(ending_of(options.output));
  if (!form)
    throw InputError("--output",
                     "must be a name that ends in .svg, .csv or .json (got " + options.output + ")");
  const RenderRequest request = read_render_flags(options.render);
  require_writable(options.output);
  if (!options.pictures.empty()) {
    std::error_code failed;
    std::filesystem::create_directories(options.pictures, failed);
    if (!std::filesystem::is_directory(options.pictures, failed))
      throw FileError("cannot write to " + options.pictures +
                      " (--pictures): not a folder and cannot be created");
    require_writable((std::filesystem::path(options.pictures) / "0.png").string());
  }
  std::optional<ProgressBar> bar(std::in_place, "pictures");
  bar->say("reading " + options.render.scene);
  const PreparedScene scene(load_scene_file(options.render.scene));
  const SignalWatch signals;
  ThreadExecutor executor(options.threads);
  options.extent.threads = executor.threads();
  Study study = with_flag_names([&] { return Study(scene.scene(), request, options.extent); });
  for (int number = 0; number < study.pictures(); ++number) {
    study.add(
        render_picture(scene, study.request(number), FilmStorage::linear32, executor, signals.interrupted()));
    bar->update(number + 1, study.pictures());
  }
  bar.reset();
  write_file(options.output, form->write(study.chart(), ""));
  if (!options.pictures.empty()) write_pictures(options.pictures, study, scene, executor, signals);
  print_recommendations(study.chart());
  return kDone;
}

}  // namespace

Command add_chart(CLI::App& root) {
  const auto options = std::make_shared<ChartOptions>();
  CLI::App* app = root.add_subcommand("chart", "Chart speed against accuracy of an image");
  app->footer(kChartExamples);
  app->add_option("-o,--output", options->output, "Chart file: .svg, .csv or .json (required)")
      ->type_name("FILE")
      ->required()
      ->group(kCommonGroup);
  add_render_flags(*app, options->render, CommonOptions(kCommonOptions).first(2));  // width, height
  add_threads_flag(*app, options->threads);
  app->add_option("--chart-samples", options->extent.samples,
                  with_range("Maximum samples per pixel of the configurations 1, 4, 16, ...", 1,
                             kMaxChartSamples, std::to_string(options->extent.samples)))
      ->check(integer_from(1, kMaxChartSamples))
      ->type_name("N")
      ->group("Chart");
  app->add_option("--rounds", options->extent.rounds,
                  with_range("Maximum images per configuration, with different seeds; two if dominated", 1,
                             kMaxChartRounds, std::to_string(options->extent.rounds)))
      ->check(integer_from(1, kMaxChartRounds))
      ->type_name("N")
      ->group("Chart");
  app->add_option("--chart-width", options->extent.width,
                  with_range("Width of the rendered images in pixels; times are predicted for full width", 1,
                             kMaxImageSide, "full width"))
      ->check(integer_from(1, kMaxImageSide))
      ->type_name("N")
      ->group("Chart");
  app->add_option("--pictures", options->pictures, "Folder for PNG files of the Pareto front")
      ->type_name("DIR")
      ->group("Output");
  return {app, [options] { return chart(*options); }};
}

}  // namespace orrery
