#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/stability/line_chart.h"
#include "core/stability/registry.h"
#include "core/stability/report.h"
#include "core/stability/speed.h"
#include "server/api/stability_json.h"
#include "server/commands/checks.h"
#include "server/commands/commands.h"
#include "server/commands/help_layout.h"
#include "server/commands/output_file.h"
#include "server/commands/progress.h"

namespace orrery {
namespace {

constexpr const char* kStabilityExamples = R"(
Examples:
  orrery stability
  orrery stability --json
  orrery stability --docs docs      # writes docs/stability.md and its images
  orrery stability --speed --svg speed.svg

Measures the errors of naive numerical methods and of the methods used here,
which takes 0.3 s. Exit status 1 if a method exceeds its bound. --speed measures
ratios of CPU times instead, in interleaved runs.
)";

struct StabilityOptions {
  bool json = false;
  std::string docs;
  bool speed = false;
  std::string svg;
  int rounds = 9;
};

void write_docs(const std::string& folder, std::span<const StabilityResult> results) {
  write_file(folder + "/stability.md", stability_markdown(results));
  for (const StabilityResult& result : results)
    if (const auto& chart = result.figures.chart)
      write_file(folder + "/pictures/stability-" + chart->name + ".svg", svg_of(*chart));
}

int speed(const StabilityOptions& options) {
  if (!options.svg.empty() && !options.svg.ends_with(".svg"))
    throw InputError("--svg", "must be a name that ends in .svg (got " + options.svg.substr(0, 40) + ")");
  if (!options.svg.empty()) require_writable(options.svg);
  std::optional<ProgressBar> bar(std::in_place, "rounds");
  const std::vector<SpeedGroup> groups =
      measure_speed(options.rounds, [&](int done, int all) { bar->update(done, all); });
  bar.reset();
  std::cout << speed_text(groups);
  if (!options.svg.empty()) write_file(options.svg, svg_of(groups));
  return kDone;
}

int stability(const StabilityOptions& options) {
  if (options.speed) return speed(options);
  const std::vector<StabilityResult> results = measure_stability();
  if (!options.docs.empty())
    write_docs(options.docs, results);
  else
    std::cout << (options.json ? stability_json(results).dump(2) + "\n" : stability_text(results));
  const bool all_hold =
      std::all_of(results.begin(), results.end(), [](const auto& result) { return result.holds(); });
  return all_hold ? kDone : kFailed;
}

}  // namespace

Command add_stability(CLI::App& root) {
  const auto options = std::make_shared<StabilityOptions>();
  CLI::App* app =
      root.add_subcommand("stability", "Measure errors of naive numerical methods and of those used here");
  app->footer(kStabilityExamples);
  CLI::Option* json = app->add_flag("--json", options->json, "Print JSON");
  app->add_option("--docs", options->docs,
                  "Write stability.md and its charts to a folder; charts go to FOLDER/pictures")
      ->type_name("FOLDER")
      ->excludes(json);
  CLI::Option* speed = app->add_flag("--speed", options->speed, "Print the CPU time of methods, as ratios")
                           ->excludes(json)
                           ->excludes("--docs");
  app->add_option("--svg", options->svg, "With --speed: also draw a chart")
      ->type_name("FILE.svg")
      ->needs(speed);
  app->add_option("--rounds", options->rounds,
                  with_range("With --speed: runs per method, to report their median", 7, 1000,
                             std::to_string(options->rounds)))
      ->check(integer_from(7, 1000))
      ->type_name("N")
      ->needs(speed);
  return {app, [options] { return stability(*options); }};
}

}  // namespace orrery
