#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "core/plan/plan.h"
#include "core/plan/warnings.h"
#include "server/commands/commands.h"
#include "server/commands/scene_file.h"

namespace orrery {
namespace {

constexpr const char* kCheckExamples = R"(
Examples:
  orrery check my-scene.json
  orrery check --json scenes/*.json

Prints a line for each problem: the file, where in it (a JSON Pointer), and what was expected; and for each
warning: why a picture by the scene's own camera would show nothing useful. The status is 0 if all scenes are
good, with or without warnings, and 2 if not.
)";

struct CheckOptions {
  std::vector<std::string> scenes;
  bool json = false;
};

nlohmann::ordered_json json_of(const std::string& file, const Problem& problem, const char* severity) {
  return {{"file", file}, {"severity", severity}, {"pointer", problem.pointer}, {"detail", problem.detail}};
}

std::string line_of(const std::string& file, const Problem& warning) {
  return file + ": " + warning.pointer + ": warning: " + warning.detail;
}

int check(const CheckOptions& options) {
  nlohmann::ordered_json found = nlohmann::ordered_json::array();
  bool good = true;
  for (const std::string& file : options.scenes) {
    try {
      const auto scene = load_scene_file(file);
      for (const Problem& p : find_warnings(*scene, make_plan(*scene, {}))) {
        found.push_back(json_of(file, p, "warning"));
        if (!options.json) std::cout << line_of(file, p) << "\n";
      }
    } catch (const BadScene& error) {
      good = false;
      for (const Problem& p : error.problems()) found.push_back(json_of(file, p, "error"));
      if (!options.json)
        for (const std::string& line : error.lines()) std::cout << line << "\n";
    }
  }
  if (options.json) std::cout << found.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
  return good ? kDone : kBadInput;
}

}  // namespace

Command add_check(CLI::App& root) {
  const auto options = std::make_shared<CheckOptions>();
  CLI::App* app = root.add_subcommand("check", "Say what is wrong with scenes");
  app->footer(kCheckExamples);
  app->add_option("SCENE", options->scenes, "JSON files of scenes, or - for standard input")->required();
  app->add_flag("--json", options->json, "Print problems and warnings as a JSON array");
  return {app, [options] { return check(*options); }};
}

}  // namespace orrery
