#include <CLI/CLI.hpp>

#include "core/load/scene_file.h"
#include "server/commands/commands.h"
#include "server/commands/render_image.h"

namespace orrery {
namespace {

constexpr const char* kRenderExamples = R"(
Examples:
  orrery render scenes/paper.json -o paper.png
  orrery render scenes/glass.json -o glass.png --width 1920 --height 1080
  orrery render scenes/paper.json -o turned.exr --azimuth 30 --elevation 10
  orrery render scenes/cornell-box.json -o box.png --error 0.02
  orrery render scenes/cornell-box.json -o box.png --seconds 2
  orrery render scenes/paper.json -o - --format jpeg > paper.jpg
  orrery render scenes/paper.json --stats           # statistics, no image
)";

}  // namespace

Command add_render(CLI::App& root) {
  const auto options = std::make_shared<RenderOptions>();
  CLI::App* app = root.add_subcommand("render", "Render a scene to an image");
  app->footer(kRenderExamples);
  add_output_flags(*app, *options);
  add_render_flags(*app, options->render);
  add_threads_flag(*app, options->threads);
  return {app, [options] {
            return render_image(*options,
                                [&](const RenderRequest&) { return load_scene_file(options->render.scene); });
          }};
}

}  // namespace orrery
