#include "server/commands/render_flags.h"

#include <CLI/CLI.hpp>

#include "core/model/batch.h"
#include "core/render/views.h"
#include "server/app/flag_name.h"
#include "server/app/render_options.h"
#include "server/http/target.h"

namespace orrery {
namespace {

// Returns the flag name that errors use.
std::string short_flag_of(const RenderOption& option) {
  return flag_of(option.short_name.empty() ? option.key : option.short_name);
}

std::string flags_of(const RenderOption& option) {
  return option.short_name.empty() ? flag_of(option.key) : short_flag_of(option) + "," + flag_of(option.key);
}

// Returns the help text without its full stop.
std::string help_of(const RenderOption& option) {
  return std::string(option.help.substr(0, option.help.size() - option.help.ends_with('.')));
}

// Returns the options of --plan. A URL counts from its "?" on; without "?" it has no options.
std::vector<OptionText> texts_of_plan(std::string_view plan) {
  if (plan.find('?') == plan.npos && plan.find('/') != plan.npos) return {};
  const auto called = [](std::string_view name) { return "--plan " + std::string(name); };
  try {
    return option_texts(parse_target("/?" + std::string(plan.substr(plan.find('?') + 1))).query, called);
  } catch (const HttpError& error) {
    throw InputError("--plan", error.what());
  }
}

}  // namespace

void add_render_flags(CLI::App& app, RenderFlags& flags) {
  app.add_option("SCENE", flags.scene, "The scene's JSON file, or - for standard input")->required();
  const auto options = render_options();
  flags.texts.resize(options.size());
  for (std::size_t i = 0; i < options.size(); ++i) {
    CLI::Option* option = app.add_option(flags_of(options[i]), flags.texts[i], help_of(options[i]));
    option->type_name(options[i].value_name())->group("Picture");
    flags.options.push_back(option);
  }
  app.add_option(
         "--plan", flags.plan,
         "Any of these options as an address has them, such as a plan that was printed; what is given "
         "beside it counts")
      ->type_name("A=B&C=D")
      ->group("Picture");
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
  std::vector<OptionText> texts = texts_of_plan(flags.plan);
  for (std::size_t i = 0; i < flags.options.size(); ++i) {
    if (flags.options[i]->count() == 0) continue;
    const RenderOption& option = render_options()[i];
    std::erase_if(texts, [&](const OptionText& text) { return text.option == &option; });
    texts.push_back({&option, short_flag_of(option), flags.texts[i]});
  }
  RenderRequest request = read_option_texts(texts);
  request.full_model = flags.full_model;
  request.slice = flags.slice;
  return request;
}

RenderRequest read_picture_flags(const RenderFlags& flags, std::optional<FileFormat> format) {
  RenderRequest request = read_render_flags(flags);
  try {
    choose_space(request, format.value_or(FileFormat::png));
    if (format) require_layers_kept(request, *format);
  } catch (const InputError& error) {
    throw with_flag_names(error);
  }
  return request;
}

InputError with_flag_names(const InputError& error) {
  std::vector<Problem> problems = error.problems();
  for (Problem& problem : problems)
    for (const RenderOption& option : render_options())
      if (problem.pointer == option.pointer()) problem.pointer = short_flag_of(option);
  return InputError(std::move(problems));
}

}  // namespace orrery
