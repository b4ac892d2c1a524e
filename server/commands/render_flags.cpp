#include "server/commands/render_flags.h"

#include <CLI/CLI.hpp>

#include <algorithm>

#include "core/model/batch.h"
#include "core/render/views.h"
#include "server/api/render_options.h"
#include "server/commands/checks.h"
#include "server/commands/help_layout.h"
#include "server/commands/option_help.h"
#include "server/config/flag_name.h"
#include "server/http/target.h"

namespace orrery {
namespace {

// Returns the flag name for error messages.
std::string short_flag_of(const RenderOption& option) {
  return flag_of(option.short_name.empty() ? option.key : option.short_name);
}

std::string flags_of(const RenderOption& option) {
  return option.short_name.empty() ? flag_of(option.key) : short_flag_of(option) + "," + flag_of(option.key);
}

// Returns the options of --plan. Ignores a URL up to its "?". A URL without "?" has no options.
std::vector<OptionText> texts_of_plan(std::string_view plan) {
  if (plan.find('?') == plan.npos && plan.find('/') != plan.npos) return {};
  const auto called = [](std::string_view name) { return "--plan " + std::string(name); };
  try {
    return option_texts(parse_target("/?" + std::string(plan.substr(plan.find('?') + 1))).query, called);
  } catch (const HttpError& error) {
    throw InputError("--plan", error.what());
  }
}

constexpr int kMaxThreads = 1024;

void add_threads(CLI::App& app, int& threads, const std::string& group) {
  app.add_option("--threads", threads,
                 with_range("Render threads; 0: one per core", 0, kMaxThreads, std::to_string(threads)))
      ->check(integer_from(0, kMaxThreads))
      ->type_name("N")
      ->group(group);
}

// Adds the flags of all image options. `before`: prefix of the group names.
void add_image_flags(CLI::App& app, RenderFlags& flags, CommonOptions common, const std::string& before) {
  const auto options = render_options();
  flags.texts.resize(options.size());
  for (std::size_t i = 0; i < options.size(); ++i) {
    CLI::Option* option = app.add_option(flags_of(options[i]), flags.texts[i], help_of(options[i]));
    const bool is_common = std::find(common.begin(), common.end(), options[i].key) != common.end();
    option->type_name(options[i].value_name())
        ->group(is_common ? kCommonGroup : before + std::string(heading_of(options[i])));
    flags.options.push_back(option);
  }
  app.add_flag("--full-model", flags.full_model, "Run all stages, even those that the scene does not need")
      ->group(before + "Speed");
  app.add_option("--slice", flags.slice,
                 with_range("Rays processed together by each stage; does not change the image", 16, kBatch,
                            std::to_string(flags.slice)))
      ->check(integer_from(16, kBatch))
      ->type_name("N")
      ->group(before + "Speed");
  app.add_option("--plan", flags.plan,
                 "Image options as a query or URL, such as a printed plan; other options override it")
      ->type_name("A=B&C=D")
      ->group(before + "Plan");
}

}  // namespace

void add_render_flags(CLI::App& app, RenderFlags& flags, CommonOptions common) {
  app.add_option("SCENE", flags.scene, "Scene file (JSON), or - for standard input")
      ->required()
      ->group("Arguments");
  add_image_flags(app, flags, common, std::string(kListed));
}

void add_model_flags(CLI::App& app, RenderFlags& flags) {
  app.add_option("MODEL", flags.scene, "OBJ, PLY, STL, 3MF or glTF file, or - for standard input")
      ->required()
      ->group("Arguments");
  add_image_flags(app, flags, kCommonOptions, std::string(kListed));
}

void add_threads_flag(CLI::App& app, int& threads) {
  add_threads(app, threads, std::string(kListed) + "Speed");
}

std::string image_options_help() {
  CLI::App app;
  RenderFlags flags;
  int threads = 0;
  app.set_help_flag();
  add_image_flags(app, flags, {}, "");
  add_threads(app, threads, "Speed");
  return R"(Image options of render, orbit, explain, chart and audit.
An option overrides the value in the scene. Requests use the same names in JSON
and in queries: "max_depth" for --max-depth. A default applies if the scene has
no value.
)" + option_groups_text(app);
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
  with_flag_names([&] {
    choose_space(request, format.value_or(FileFormat::png));
    if (format) require_layers_kept(request, *format);
  });
  return request;
}

InputError name_flags(const InputError& error) {
  std::vector<Problem> problems = error.problems();
  for (Problem& problem : problems)
    for (const RenderOption& option : render_options())
      if (problem.pointer == option.pointer()) problem.pointer = short_flag_of(option);
  return InputError(std::move(problems));
}

}  // namespace orrery
