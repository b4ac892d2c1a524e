#include "server/commands/help_layout.h"

#include <CLI/CLI.hpp>
#include <sstream>

#include "core/params/params.h"

namespace orrery {
namespace {

constexpr std::size_t kLineWidth = 80;      // in columns
constexpr std::size_t kOptionColumn = 28;   // column of option descriptions
constexpr std::size_t kCommandColumn = 13;  // column of command descriptions
constexpr std::size_t kListColumn = 10;     // column of listed option names

// Returns "  NAME" padded to `column`, followed by `text`. Wraps `text` and indents it to `column`.
std::string help_entry(const std::string& name, const std::string& text, std::size_t column) {
  std::string whole, last = "  " + name;  // complete lines, current line
  const auto end_line = [&] {
    whole += last + "\n";
    last = "";
  };
  if (!text.empty() && last.size() + 2 > column) end_line();
  if (!text.empty()) last.resize(column, ' ');
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const bool is_first = last.size() == column;
    if (!is_first && last.size() + 1 + word.size() > kLineWidth) {
      end_line();
      last.resize(column, ' ');
    }
    last += (last.size() == column ? "" : " ") + word;
  }
  return whole + last + "\n";
}

class HelpFormatter final : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode) const override {
    std::string text = app->get_description() + ".\n";
    if (app->get_parent() == nullptr) {
      text += "Usage: " + name + " [--help] [--version] COMMAND [ARGUMENTS]\n\nCommands:\n";
      for (const CLI::App* command : app->get_subcommands({}))
        text += help_entry(command->get_name(), command->get_description(), kCommandColumn);
    } else {
      text += make_usage(app, name) + make_positionals(app) + option_groups(*app);
    }
    return text + app->get_footer();
  }

  std::string option_groups(const CLI::App& app) const {
    std::string described, listed;
    for (const std::string& group : app.get_groups()) {
      const auto options = app.get_options([&group](const CLI::Option* option) {
        return option->get_group() == group && option->nonpositional();
      });
      if (options.empty() || group.empty()) continue;
      if (group.starts_with(kListed))
        listed += help_entry(group.substr(kListed.size()), names_of(options), kListColumn);
      else
        described += make_group(group, false, options);
    }
    if (listed.empty()) return described;
    return described + "\nImage options, described by `orrery help options`:\n" + listed;
  }

  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    return help_entry(make_option_name(option, is_positional) + make_option_opts(option),
                      make_option_desc(option), kOptionColumn);
  }
  std::string make_option_name(const CLI::Option* option, bool is_positional) const override {
    if (is_positional) return option->get_name(true, false);
    std::string names;
    for (const std::string& name : option->get_snames()) names += (names.empty() ? "-" : ", -") + name;
    for (const std::string& name : option->get_lnames()) names += (names.empty() ? "--" : ", --") + name;
    return names;
  }
  std::string make_option_opts(const CLI::Option* option) const override {
    const std::string& text = option->get_option_text();
    if (!text.empty()) return (text.front() == '[' ? "" : " ") + text;  // --stats[=json], --format NAME
    if (option->get_positional() || option->get_type_size() == 0 || option->get_type_name().empty())
      return "";
    return " " + option->get_type_name();
  }

 private:
  static std::string names_of(const std::vector<const CLI::Option*>& options) {
    std::string names;
    for (const CLI::Option* option : options)
      names += (names.empty() ? "--" : " --") + option->get_lnames().front();
    return names;
  }
};

}  // namespace

void set_help_layout(CLI::App& root) {
  const auto formatter = std::make_shared<HelpFormatter>();
  formatter->label("Positionals", "Arguments");
  root.formatter(formatter);
}

std::string option_groups_text(const CLI::App& app) { return HelpFormatter().option_groups(app); }

std::string range_text(double min, double max) {
  return number_text(min) + (min < 0 ? " to " : "-") + number_text(max);
}

std::string with_range(std::string_view help, double min, double max, std::string_view fallback) {
  std::string text = std::string(help) + " (" + range_text(min, max);
  if (!fallback.empty()) text += ", default " + std::string(fallback);
  return text + ")";
}

}  // namespace orrery
