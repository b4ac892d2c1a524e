#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "core/load/asset_files.h"
#include "core/load/load.h"
#include "core/load/scene_file.h"
#include "core/model/asset_source.h"
#include "core/model/model_images.h"
#include "core/params/json.h"
#include "core/params/params.h"
#include "server/api/view_scene.h"
#include "server/commands/commands.h"
#include "server/commands/output_file.h"
#include "server/commands/render_image.h"
#include "server/config/flag_name.h"

namespace orrery {
namespace {

constexpr const char* kViewExamples = R"(
Examples:
  orrery view part.stl -o part.png
  orrery view chair.glb -o chair.png --from front --width 1024 --height 1024
  orrery view part.stl -o - --ground shadow > part.png
  orrery view robot.glb -o robot.png --pose-time 1.5 --animation 2
  orrery view robot.glb --pose-time all --print-scene -o robot.json
  orrery view part.stl --print-scene -o part.json    # the scene, as JSON

Renders an OBJ, PLY, STL, 3MF or glTF file without a scene: frames the model
exactly, lights it evenly and from the upper left. Images have 512 x 512 pixels
and an RMS error of 0.02, unless options set the size, samples, error or time.
A ZIP archive is read as the one model in it, with the files that it names.
--print-scene prints the scene instead, which orrery render accepts.
)";

struct ViewFlags {
  bool print_scene = false;
  std::vector<std::string> texts;  // values, in the order of view_parameters()
  RenderOptions render;
};

struct View {
  OneModel model;
  nlohmann::ordered_json scene;
};

// Returns make(). Errors of options name flags instead of keys.
template <class Make>
auto naming_flags(const Make& make) {
  try {
    return make();
  } catch (const InputError& error) {
    std::vector<Problem> problems = error.problems();
    bool is_option = false;
    for (Problem& problem : problems)
      for (const ViewParameter& parameter : view_parameters())
        if (problem.pointer == "/" + std::string(parameter.key)) {
          problem.pointer = flag_of(parameter.key);
          is_option = true;
        }
    if (!is_option) throw;
    throw InputError(std::move(problems));
  }
}

ViewOptions options_of(const ViewFlags& flags) {
  nlohmann::json given = nlohmann::json::object();
  for (std::size_t i = 0; i < flags.texts.size(); ++i)
    if (!flags.texts[i].empty()) given[std::string(view_parameters()[i].key)] = flags.texts[i];
  return naming_flags([&] { return read_view_options(document_of(std::move(given))); });
}

std::string help_of(const ViewParameter& parameter) {
  std::string help(parameter.help.substr(0, parameter.help.size() - 1));
  for (const std::string_view name : parameter.names)
    help += (name == parameter.names.front() ? ": " : ", ") + std::string(name);
  return parameter.fallback.empty() ? help : help + " [" + std::string(parameter.fallback) + "]";
}

// Replaces the default in the help of a flag, which is that of scenes.
void set_default(CLI::App& app, const char* flag, double fallback) {
  CLI::Option* const option = app.get_option(flag);
  const std::string help = option->get_description();
  option->description(help.substr(0, help.rfind("default ")) + "default " + number_text(fallback) + ")");
}

View view_of(const ViewFlags& flags, const RenderRequest& request) {
  const ViewOptions options = options_of(flags);
  const std::string& path = flags.render.render.scene;
  const ModelStates states = naming_flags([&] {
    return read_states(options, [&](const ModelState& state) { return read_model_file(path, state).model; });
  });
  for (const std::string& note : notes_of(*states.begin()->second))
    std::cerr << "orrery: warning: " << path << ": " << note << "\n";
  const std::string name = path == "-" ? "model" : std::filesystem::path(path).filename().string();
  const auto [width, height] = view_size(request);
  return {OneModel(states), naming_flags([&] {
            return view_scene(states, {"file", name, name}, options, width, height);
          })};
}

int view(const ViewFlags& flags) {
  if (flags.print_scene) {
    const View made = view_of(flags, read_render_flags(flags.render.render));
    write_file(flags.render.output.value_or("-"),
               made.scene.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    return kDone;
  }
  return render_image(flags.render, [&](const RenderRequest& request) {
    const View made = view_of(flags, request);
    return load_scene(document_of(made.scene), made.model);
  });
}

}  // namespace

Command add_view(CLI::App& root) {
  const auto flags = std::make_shared<ViewFlags>();
  CLI::App* app = root.add_subcommand("view", "Render a model without a scene");
  app->footer(kViewExamples);
  flags->render.complete = with_view_budget;
  add_output_flags(*app, flags->render);
  flags->texts.resize(view_parameters().size());
  for (std::size_t i = 0; i < flags->texts.size(); ++i) {
    const ViewParameter& parameter = view_parameters()[i];
    app->add_option(flag_of(parameter.key), flags->texts[i], help_of(parameter))
        ->type_name(std::string(parameter.placeholder))
        ->group(kCommonGroup);
  }
  add_model_flags(*app, flags->render.render);
  const ImageSize size = view_size({});
  set_default(*app, "--width", size.width);
  set_default(*app, "--height", size.height);
  set_default(*app, "--error", *with_view_budget({}).error);
  app->add_flag("--print-scene", flags->print_scene, "Print the scene as JSON instead of rendering it")
      ->group("Output");
  add_threads_flag(*app, flags->render.threads);
  return {app, [flags] { return view(*flags); }};
}

}  // namespace orrery
