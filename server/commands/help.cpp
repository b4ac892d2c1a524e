#include <CLI/CLI.hpp>

#include "core/base/error.h"
#include "core/params/suggest.h"
#include "server/commands/commands.h"
#include "server/commands/render_flags.h"

namespace orrery {
namespace {

constexpr const char* kHelpExamples = R"(
Examples:
  orrery help
  orrery help render
  orrery help options
)";

int print_help(const CLI::App& root, const std::string& topic) {
  std::vector<std::string> topics{"options"};
  if (topic.empty()) {
    std::cout << root.get_formatter()->make_help(&root, root.get_name(), CLI::AppFormatMode::Normal);
    return kDone;
  }
  if (topic == topics.front()) {
    std::cout << image_options_help();
    return kDone;
  }
  for (const CLI::App* command : root.get_subcommands({})) {
    topics.push_back(command->get_name());
    if (topic != topics.back()) continue;
    std::cout << command->help(root.get_name());
    return kDone;
  }
  const std::vector<std::string_view> known(topics.begin(), topics.end());
  const auto meant = nearest(topic, known);
  throw InputError("", "unknown topic \"" + topic + "\"" + question_of(meant) + "; see orrery --help");
}

}  // namespace

Command add_help(CLI::App& root) {
  const auto topic = std::make_shared<std::string>();
  CLI::App* app = root.add_subcommand("help", "Print the help of a command, or of all image options");
  app->footer(kHelpExamples);
  app->add_option("TOPIC", *topic, "Command, or `options` for the image options")->group("Arguments");
  return {app, [&root, topic] { return print_help(root, *topic); }};
}

}  // namespace orrery
