#include "server/commands/run.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <optional>

#include "core/base/version.h"
#include "core/budget/renderer.h"
#include "core/load/scene_file.h"
#include "core/math/instruction_level.h"
#include "core/params/suggest.h"
#include "server/commands/commands.h"
#include "server/commands/help_layout.h"

namespace orrery {
namespace {

constexpr auto kCommands = {add_render,  add_view,      add_inspect, add_import, add_orbit,   add_check,
                            add_explain, add_chart,     add_history, add_audit,  add_catalog, add_schema,
                            add_openapi, add_stability, add_serve,   add_token,  add_help};

constexpr const char* kProgramExamples = R"(
Example: orrery render scenes/paper.json -o paper.png
Exit status: 0 success, 1 failure, 2 bad input, 3 missed budget, 130 stopped
)";

int fail(int status, const std::string& message) {
  std::cerr << "orrery: " << message << "\n";
  return status;
}

// Returns an error message if the first argument is a word that names no command, else nullopt.
std::optional<std::string> unknown_command(int argc, char** argv, const std::vector<Command>& commands) {
  if (argc < 2 || argv[1][0] == '-') return std::nullopt;
  const std::string word = argv[1];
  std::vector<std::string> names;
  for (const Command& command : commands) names.push_back(command.app->get_name());
  if (std::find(names.begin(), names.end(), word) != names.end()) return std::nullopt;
  const std::vector<std::string_view> views(names.begin(), names.end());
  const auto meant = nearest(word, views);
  return "unknown command \"" + word + "\"" + question_of(meant) + "; see orrery --help";
}

// Returns an error message that lists the unknown options with suggestions. Lists the unknown arguments if no
// option is unknown.
std::string unknown_words(const CLI::App& app) {
  const CLI::App& command = *app.get_subcommands().front();
  std::vector<std::string> flags;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) flags.push_back(name);
  const std::vector<std::string_view> known(flags.begin(), flags.end());
  const auto add = [](std::string& list, const std::string& entry) {
    list += (list.empty() ? "" : ", ") + entry;
  };
  std::string arguments, options;
  for (const std::string& word : app.remaining(true)) {
    add(arguments, "unknown argument \"" + word + "\"");
    if (!word.starts_with("--")) continue;
    const std::string name = word.substr(0, word.find('='));
    const auto meant = nearest_key(name.substr(2), known);
    add(options, "unknown option " + name + question_of(meant, "--"));
  }
  return (options.empty() ? arguments : options) + "; see orrery " + command.get_name() + " --help";
}

int run_chosen(const std::vector<Command>& commands) {
  try {
    for (const Command& command : commands)
      if (command.app->parsed()) return command.run();
    return kBadInput;
  } catch (const BadScene& error) {
    for (const std::string& line : error.lines()) std::cerr << line << "\n";
    return kBadInput;
  } catch (const InputError& error) {
    for (const Problem& p : error.problems()) std::cerr << "orrery: " << p.text() << "\n";
    return kBadInput;
  } catch (const BudgetMissed& error) {
    return fail(kMissed, error.what());
  } catch (const Cancelled&) {
    return fail(kInterrupted, "interrupted");
  } catch (const std::exception& error) {
    return fail(kFailed, error.what());
  }
}

}  // namespace

int run(int argc, char** argv) {
  try {
    CLI::App app("Render 3D scenes to images, on the command line or over HTTP", "orrery");
    set_help_layout(app);
    app.set_version_flag("--version", std::string(kVersion) + " (" + std::string(instruction_level()) + ")");
    app.require_subcommand(1);
    std::vector<Command> commands;
    for (const auto& add : kCommands) {
      commands.push_back(add(app));
      commands.back().app->set_help_flag("-h,--help", "Print this help and exit");  // listed last
    }
    app.footer(kProgramExamples);  // commands added later would inherit it
    if (const auto problem = unknown_command(argc, argv, commands)) return fail(kBadInput, *problem);
    try {
      app.parse(argc, argv);
    } catch (const CLI::ExtrasError&) {
      return fail(kBadInput, unknown_words(app));
    } catch (const CLI::ParseError& error) {
      return app.exit(error) == 0 ? kDone : kBadInput;
    }
    const int status = run_chosen(commands);
    if (!std::cout.flush()) return fail(kFailed, "cannot write to standard output");
    return status;
  } catch (const std::exception& error) {
    return fail(kFailed, error.what());
  }
}

}  // namespace orrery
