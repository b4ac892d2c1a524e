#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "core/plan/options.h"

// Tests the layout and content of the program's help.
namespace orrery {
namespace {

constexpr const char* kCommandNames[] = {"render",    "view",  "inspect", "history", "orbit",  "check",
                                         "explain",   "chart", "audit",   "catalog", "schema", "openapi",
                                         "stability", "serve", "token",   "import",  "help"};
constexpr const char* kImageCommands[] = {"render", "view", "history", "orbit", "explain", "chart", "audit"};

struct HelpRun {
  int status;
  std::string text;  // standard output and standard error
};

HelpRun run_program(const std::string& arguments) {
  const char* program = std::getenv("TEST_ORRERY");
  const std::string command = std::string(program ? program : "orrery") + " " + arguments + " 2>&1";
  std::FILE* pipe = popen(command.c_str(), "r");
  HelpRun run{-1, ""};
  if (!pipe) return run;
  char block[4096];
  for (std::size_t count; (count = std::fread(block, 1, sizeof block, pipe)) > 0;)
    run.text.append(block, count);
  run.status = pclose(pipe) >> 8;  // exit status of a shell
  return run;
}

std::vector<std::string> lines_of_help(const std::string& arguments) {
  const HelpRun run = run_program(arguments);
  EXPECT_EQ(run.status, 0) << run.text;
  std::istringstream text(run.text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

TEST(Help, ListsCommandsOnOneScreen) {
  const std::vector<std::string> lines = lines_of_help("--help");
  EXPECT_LE(lines.size(), 24U);
  for (const char* command : kCommandNames)
    EXPECT_EQ(std::count_if(lines.begin(), lines.end(),
                            [&](const std::string& line) {
                              return line.starts_with("  " + std::string(command) + " ");
                            }),
              1)
        << command;
}

TEST(Help, HasAtMost80Columns) {
  std::vector<std::string> topics{"", "options"};
  topics.insert(topics.end(), std::begin(kCommandNames), std::end(kCommandNames));
  for (const std::string& topic : topics)
    for (const std::string& line : lines_of_help("help " + topic)) EXPECT_LE(line.size(), 80U) << line;
}

TEST(Help, PrintsSameTextForFlagAndHelpCommand) {
  for (const std::string command : kCommandNames) {
    const HelpRun by_flag = run_program(command + " --help"), by_command = run_program("help " + command);
    EXPECT_EQ(by_flag.status, 0) << command;
    EXPECT_EQ(by_command.status, 0) << command;
    EXPECT_EQ(by_flag.text, by_command.text);
  }
  EXPECT_EQ(run_program("--help").text, run_program("help").text);
}

TEST(Help, ListsCommonOptionsFirstInFixedOrder) {
  for (const char* command : {"render", "view", "orbit"}) {
    const std::string text = run_program(std::string(command) + " --help").text;
    std::size_t before = text.find("Common options:");
    ASSERT_NE(before, std::string::npos) << command;
    for (const char* option :
         {"-o, --output ", "--width ", "--height ", "--samples ", "--error, ", "--seconds, ", "Output:"}) {
      const std::size_t at = text.find(option);
      ASSERT_NE(at, std::string::npos) << option;
      EXPECT_GT(at, before) << option;
      before = at;
    }
  }
}

// The help of each image command names every image option. Only `help options` describes the options that are
// not common.
TEST(Help, ListsImageOptionsByNameInCommandHelp) {
  const std::string described = run_program("help options").text;
  for (const RenderOption& option : render_options()) {
    const std::string name(option.short_name.empty() ? option.key : option.short_name);
    std::string flag = "--" + name;
    std::replace(flag.begin(), flag.end(), '_', '-');
    EXPECT_NE(described.find("  " + flag), std::string::npos) << flag;
    for (const char* command : kImageCommands)
      EXPECT_NE(run_program(std::string(command) + " --help").text.find(flag), std::string::npos)
          << command << " " << flag;
  }
  const std::string of_clamp = "Limit of a sample's indirect radiance";
  EXPECT_NE(described.find(of_clamp), std::string::npos);
  for (const char* command : kImageCommands) {
    const std::string text = run_program(std::string(command) + " --help").text;
    EXPECT_EQ(text.find(of_clamp), std::string::npos) << command;
    EXPECT_NE(text.find("orrery help options"), std::string::npos) << command;
  }
}

TEST(Help, ShowsRangesAndDefaults) {
  const std::string serve = run_program("help serve").text;
  const std::string options =  // without line breaks
      std::regex_replace(run_program("help options").text, std::regex("\\s+"), " ");
  for (const char* note : {"(1-4096, default 600)", "(-180 to 180, default 0)", "default whitted)",
                           "Default: 5; distributed 6; path 9 (0-32)", "(default false)"})
    EXPECT_NE(options.find(note), std::string::npos) << note << "\n" << options;
  EXPECT_NE(serve.find("default 8080)"), std::string::npos) << serve;
}

// A view has other defaults than a scene. Options without a default show none.
TEST(Help, ShowsTheDefaultsOfViews) {
  const std::string view = run_program("help view").text;
  for (const char* note :
       {"Image width in pixels (1-4096, default 512)", "default 0.02)", "  --format NAME "})
    EXPECT_NE(view.find(note), std::string::npos) << note << "\n" << view;
  for (const char* wrong : {"default 600", "[]"}) EXPECT_EQ(view.find(wrong), std::string::npos) << wrong;
}

TEST(Help, RejectsUnknownTopics) {
  const HelpRun wrong = run_program("help rendr");
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.text.find("unknown topic \"rendr\" (did you mean render?)"), std::string::npos)
      << wrong.text;
}

}  // namespace
}  // namespace orrery
