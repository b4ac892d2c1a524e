#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "core/load/scene_file.h"
#include "core/plan/plan.h"
#include "core/plan/warnings.h"
#include "server/commands/commands.h"

namespace orrery {
namespace {

constexpr const char* kCheckExamples = R"(
Examples:
  orrery check my-scene.json
  orrery check --json scenes/*.json

Prints one line per error or warning: file, JSON Pointer, and the allowed and
the actual value. Warnings concern the image of the scene's own camera. Exit
status: 0 if all scenes are valid, with or without warnings; 2 if not.
)";

struct CheckOptions {
  std::vector<std::string> scenes;
  bool json = false;
};

nlohmann::ordered_json json_of(const std::string& file, const Problem& problem, const char* severity) {
  return {{"file", file}, {"severity", severity}, {"pointer", problem.pointer}, {"detail", problem.detail}};
}

// Checks files one by one. Prints each finding immediately or, with `json`, all of them in finish().
class Checker {
 public:
  explicit Checker(bool json) : json_(json) {}

  void check(const std::string& file) {
    try {
      const auto scene = load_scene_file(file);
      for (const Problem& p : find_warnings(*scene, make_plan(*scene, {})))
        add(json_of(file, p, "warning"), file + ": " + p.pointer + ": warning: " + p.detail);
    } catch (const BadScene& error) {
      if (status_ == kDone) status_ = kBadInput;
      for (std::size_t i = 0; i < error.problems().size(); ++i)
        add(json_of(file, error.problems()[i], "error"), error.lines()[i]);
    } catch (const FileError& error) {
      status_ = kFailed;
      std::cerr << "orrery: " << error.what() << "\n";
      found_.push_back(json_of(file, {"", error.what()}, "error"));
    }
  }

  // Returns the exit status. That of an unreadable file takes precedence over that of an invalid scene.
  int finish() const {
    if (json_) std::cout << found_.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
    return status_;
  }

 private:
  void add(nlohmann::ordered_json finding, const std::string& line) {
    if (!json_) std::cout << line << "\n";
    found_.push_back(std::move(finding));
  }

  const bool json_;
  int status_ = kDone;
  nlohmann::ordered_json found_ = nlohmann::ordered_json::array();
};

int check(const CheckOptions& options) {
  Checker checker(options.json);
  for (const std::string& file : options.scenes) checker.check(file);
  return checker.finish();
}

}  // namespace

Command add_check(CLI::App& root) {
  const auto options = std::make_shared<CheckOptions>();
  CLI::App* app = root.add_subcommand("check", "Report errors and warnings of scenes");
  app->footer(kCheckExamples);
  app->add_option("SCENE", options->scenes, "Scene files (JSON), or - for standard input")
      ->required()
      ->group("Arguments");
  app->add_flag("--json", options->json, "Print errors and warnings as a JSON array");
  return {app, [options] { return check(*options); }};
}

}  // namespace orrery
