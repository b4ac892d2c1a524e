#include <CLI/CLI.hpp>
#include <filesystem>

#include "core/plan/limits.h"
#include "core/plan/plan.h"
#include "core/study/study.h"
#include "server/app/chart_forms.h"
#include "server/app/frame.h"
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
  orrery chart scenes/cornell-box.json -o box.json --chart-width 160 --pictures box/

Renders the scene in many ways, some rounds of each, and charts what they cost against how far they are from the
picture in double precision with four times the samples. Prints the cheapest flags for some errors. On a busy
machine times mean little; errors do.
)";

struct ChartOptions {
  std::string output, pictures;
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

RenderResult render_picture(const PreparedScene& scene, const RenderRequest& request, FilmStorage storage,
                            WorkerPool& pool, const SignalWatch& signals) {
  const SettledPlan plan = settle(scene, make_plan(scene.scene(), request), signals.interrupted());
  return render_frame(scene, plan, storage, pool, {.stop = signals.interrupted()});
}

// Returns "2-whitted-5-float-16.png", which sorts by cost.
std::string picture_name(std::size_t place, const Configuration& c) {
  return std::to_string(place) + "-" + c.technique + "-" + std::to_string(c.max_depth) + "-" +
         precision_name(c.double_precision) + "-" + std::to_string(c.samples) + ".png";
}

// Renders the Pareto front again with the seeds of the first round, and writes the pictures.
void write_pictures(const std::string& folder, const Study& study, const PreparedScene& scene,
                    WorkerPool& pool, const SignalWatch& signals) {
  const std::vector<std::size_t> front = study.chart().front();
  for (std::size_t place = 0; place < front.size(); ++place) {
    const Point& point = study.chart().points[front[place]];
    const RenderResult made =
        render_picture(scene, study.request_of(point), FilmStorage::srgb8, pool, signals);
    write_file((std::filesystem::path(folder) / picture_name(place, point.configuration)).string(),
               encode_film(made.film, FileFormat::png));
  }
}

void print_recommendations(const Chart& chart) {
  std::printf("RMS error in linear colour, time of %d threads at %d x %d pixels (95 %%), and flags:\n",
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
    throw InputError("--output", "expected a name that ends in .svg, .csv or .json, got " + options.output);
  const RenderRequest request = read_render_flags(options.render);
  require_writable(options.output);
  if (!options.pictures.empty()) {
    std::error_code failed;
    std::filesystem::create_directories(options.pictures, failed);
    if (!std::filesystem::is_directory(options.pictures, failed))
      throw FileError("cannot write to " + options.pictures +
                      " (--pictures): it is no folder, nor can be made one");
    require_writable((std::filesystem::path(options.pictures) / "0.png").string());
  }
  std::optional<ProgressBar> bar(std::in_place, "pictures");
  bar->say("reading " + options.render.scene);
  const PreparedScene scene(load_scene_file(options.render.scene));
  const SignalWatch signals;
  WorkerPool pool(options.threads);
  options.extent.threads = pool.threads();
  Study study = study_of(scene.scene(), request, options.extent);
  for (int number = 0; number < study.pictures(); ++number) {
    study.add(render_picture(scene, study.request(number), FilmStorage::linear32, pool, signals));
    bar->update(number + 1, study.pictures());
  }
  bar.reset();
  write_file(options.output, form->write(study.chart(), ""));
  if (!options.pictures.empty()) write_pictures(options.pictures, study, scene, pool, signals);
  print_recommendations(study.chart());
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
      ->check(CLI::Range(1, kMaxChartSamples).description(""))
      ->type_name("N")
      ->capture_default_str();
  app->add_option("--rounds", options->extent.rounds,
                  "Pictures of each configuration, with different seeds: two, and more of what is not beaten")
      ->check(CLI::Range(1, kMaxChartRounds).description(""))
      ->type_name("N")
      ->capture_default_str();
  app->add_option(
         "--chart-width", options->extent.width,
         "Pixels, of the pictures that are rendered; times are predicted for the picture's own width")
      ->check(CLI::Range(1, kMaxImageSide).description(""))
      ->type_name("N");
  app->add_option("--pictures", options->pictures, "A folder for PNG files of what no other beats")
      ->type_name("DIR");
  add_threads_flag(*app, options->threads);
  add_render_flags(*app, options->render);
  return {app, [options] { return chart(*options); }};
}

}  // namespace orrery
