#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "core/budget/budget.h"
#include "core/load/scene_file.h"
#include "core/plan/plan.h"
#include "server/api/explain.h"
#include "server/commands/commands.h"
#include "server/commands/render_flags.h"

namespace orrery {
namespace {

constexpr const char* kExplainExamples = R"(
Examples:
  orrery explain scenes/paper.json
  orrery explain scenes/paper.json --technique raycast --json
  orrery explain scenes/cornell-box.json --error 0.02 --measure

Each line is a decision of the plan: choice, reason and error bound. Nothing is
rendered. --measure traces some pixels to predict samples, rays, seconds and
error of the image.
)";

struct ExplainOptions {
  bool json = false, measure = false;
  int threads = 0;
  RenderFlags render;
};

int explain(const ExplainOptions& options) {
  const RenderRequest request = read_picture_flags(options.render, std::nullopt);
  const PreparedScene prepared(load_scene_file(options.render.scene));
  const Scene& scene = prepared.scene();
  const SettledPlan plan = settle(prepared, make_plan(scene, request));
  std::optional<Forecast> foretold;
  if (options.measure) {
    ThreadExecutor executor(options.threads);
    foretold = forecast(prepared, plan, executor);
  }
  std::cout << (options.json ? explain_json(scene, *plan, foretold).dump(2) + "\n"
                             : explain_text(scene, *plan, foretold));
  return kDone;
}

}  // namespace

Command add_explain(CLI::App& root) {
  const auto options = std::make_shared<ExplainOptions>();
  CLI::App* app = root.add_subcommand("explain", "Print the plan of a render, with reasons and error bounds");
  app->footer(kExplainExamples);
  add_render_flags(*app, options->render);
  add_threads_flag(*app, options->threads);
  app->add_flag("--measure", options->measure, "Trace some pixels and predict cost and error of the image")
      ->group("Output");
  app->add_flag("--json", options->json, "Print JSON")->group("Output");
  return {app, [options] { return explain(*options); }};
}

}  // namespace orrery
