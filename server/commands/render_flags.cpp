#include "server/commands/render_flags.h"

#include <CLI/CLI.hpp>

#include "core/model/batch.h"
#include "server/app/render_options.h"

namespace orrery {

void add_render_flags(CLI::App& app, RenderFlags& flags) {
  app.add_option("SCENE", flags.scene, "The scene's JSON file, or - for standard input")->required();
  const auto options = render_options();
  flags.values.resize(options.size());
  for (std::size_t i = 0; i < options.size(); ++i) {
    CLI::Option* option =
        app.add_option(std::string(options[i].flags), flags.values[i], std::string(options[i].help));
    option->type_name(std::string(options[i].value))->group("Picture");
    flags.options.push_back(option);
  }
  app.add_flag("--full-model", flags.full_model, "Leave no stage out, even where the scene does not need it")
      ->group("Advanced");
  app.add_option("--slice", flags.slice, "Rays that pass the stages together; changes no result")
      ->check(CLI::Range(16, kBatch).description(""))
      ->type_name("N")
      ->capture_default_str()
      ->group("Advanced");
}

void add_threads_flag(CLI::App& app, int& threads) {
  app.add_option("--threads", threads, "Threads that render; 0: one a core")
      ->check(CLI::Range(0, 1024).description(""))
      ->type_name("N");
}

RenderRequest read_render_flags(const RenderFlags& flags) {
  OptionValues values;
  for (std::size_t i = 0; i < flags.options.size(); ++i)
    if (flags.options[i]->count() > 0) values.emplace_back(render_options()[i].name, flags.values[i]);
  RenderRequest request = with_names_for(Naming::command_line, [&] { return read_render_options(values); });
  request.full_model = flags.full_model;
  request.slice = flags.slice;
  return request;
}

Plan plan_for(const Scene& scene, const RenderRequest& request) {
  return with_names_for(Naming::command_line, [&] { return make_plan(scene, request); });
}

}  // namespace orrery
