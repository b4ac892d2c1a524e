#include "server/commands/config.h"

#include <unistd.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "core/base/shorten.h"
#include "core/load/scene_file.h"
#include "core/params/json.h"
#include "core/params/suggest.h"
#include "server/commands/help_layout.h"
#include "server/config/flag_name.h"

namespace orrery {
namespace {

constexpr std::string_view kPrefix = "ORRERY_";
// Token variable of the page's curl examples. Not a setting, but not reported as unknown.
constexpr std::string_view kTokenOfClients = "ORRERY_TOKEN";

std::string variable_of(std::string_view name) {
  std::string variable = std::string(kPrefix) + std::string(name);
  std::transform(variable.begin(), variable.end(), variable.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return variable;
}

bool is_list(const Setting& setting) {
  return std::holds_alternative<std::vector<std::string> Settings::*>(setting.member);
}

template <class Spell>
std::vector<std::string> names_as(const Spell& spell) {
  std::vector<std::string> names;
  for (const Setting& setting : all_settings()) names.push_back(spell(setting.name));
  return names;
}

// Returns the present name of a setting and, if it has one, its former name.
std::vector<std::string_view> names_of(const Setting& setting) {
  if (setting.former.empty()) return {setting.name};
  return {setting.name, setting.former};
}

// Returns the setting with a present or former name, or null.
const Setting* find_setting(std::string_view name) {
  const auto rows = all_settings();
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const Setting& setting) {
    return setting.name == name || (!name.empty() && setting.former == name);
  });
  return row == rows.end() ? nullptr : &*row;
}

// Returns a problem for the unknown `name` of a kind such as "setting", with the most similar name of `known`
// as a suggestion.
Problem unknown(const std::string& place, const char* kind, const std::string& name,
                const std::vector<std::string>& known) {
  const std::vector<std::string_view> views(known.begin(), known.end());
  const auto meant = nearest(name, views);
  return {place, std::string("unknown ") + kind + " " + shortened(name, 80) + question_of(meant)};
}

Problem given_twice(const std::string& place, const std::string& former, const std::string& present) {
  return {place, former + " is the former name of " + present + "; give only " + present};
}

// Returns the help of a setting with its range and its default.
std::string help_of(const Setting& setting) {
  const std::string fallback = setting.text(Settings());
  if (setting.max > 0)
    return with_range(setting.help, static_cast<double>(setting.min), static_cast<double>(setting.max),
                      fallback);
  const bool has_default = !fallback.empty() && !std::holds_alternative<bool Settings::*>(setting.member);
  return std::string(setting.help) + (has_default ? " (default " + fallback + ")" : "");
}

void add_flag(CLI::App& app, const Setting& setting, const char* group) {
  const std::string help = help_of(setting);
  const bool takes_value = !std::holds_alternative<bool Settings::*>(setting.member);
  for (const std::string_view name : names_of(setting)) {
    const std::string flag = flag_of(name);
    CLI::Option* option = takes_value ? app.add_option(flag, help) : app.add_flag(flag, help);
    option->envname(variable_of(name))->group(name == setting.name ? group : "");  // "" hides it in the help
    if (takes_value) option->type_name(std::string(setting.value));
    if (is_list(setting)) option->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  }
}

void take(Settings& settings, const Setting& setting, const std::string& text, const std::string& place,
          const std::string& before, std::vector<Problem>& problems) {
  try {
    setting.read(settings, text);
  } catch (const InputError& error) {
    problems.push_back({place, before + error.problems()[0].detail});
  }
}

// Returns a value of the JSON file as the text for its flag. Throws InputError.
std::string text_of(const nlohmann::json& value, bool list) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean() || value.is_number()) return value.dump();
  if (!list || !value.is_array())
    throw InputError("", std::string(list ? "must be a string or a list of strings"
                                          : "must be a number, a string, true or false") +
                             " (got " + shortened(value.dump(), 40) + ")");
  std::string texts;
  for (const auto& entry : value) {
    if (!entry.is_string())
      throw InputError("", "must be a list of strings (got " + shortened(value.dump(), 40) + ")");
    texts += (texts.empty() ? "" : ",") + entry.get<std::string>();
  }
  return texts;
}

void read_members(Settings& settings, const nlohmann::json& json, const std::string& path,
                  std::vector<Problem>& problems) {
  for (const auto& [name, value] : json.items()) {
    const Setting* row = find_setting(name);
    const std::string before = "/" + name.substr(0, 80) + ": ";
    if (!row) {
      problems.push_back(unknown(path, "setting", name,
                                 names_as([](std::string_view known) { return std::string(known); })));
      continue;
    }
    if (name == row->former && json.contains(row->name))
      problems.push_back(given_twice(path, "/" + name, "/" + std::string(row->name)));
    try {
      take(settings, *row, text_of(value, is_list(*row)), path, before, problems);
    } catch (const InputError& error) {
      problems.push_back({path, before + error.problems()[0].detail});
    }
  }
}

// Returns the object of settings, or null if the file is unusable.
nlohmann::json read_file_of_settings(const std::string& path, std::vector<Problem>& problems) {
  try {
    const Document document = parse_document(read_file(path));
    if (json_of(document).is_object()) return json_of(document);
    problems.push_back({path, "must be an object"});
  } catch (const InputError& error) {
    for (const Problem& p : error.problems()) problems.push_back({path, p.text()});
  } catch (const FileError& error) {
    problems.push_back({"--config", error.what()});
  }
  return nullptr;
}

// Text of a setting and the flag or variable that holds it.
struct Source {
  std::string place, text;
};

std::vector<Source> variables_of(const Setting& setting) {
  std::vector<Source> sources;
  for (const std::string_view name : names_of(setting))
    if (const char* text = std::getenv(variable_of(name).c_str()))
      sources.push_back({variable_of(name), text});
  return sources;
}

// Returns the flags of a setting on the command line. CLI11 gives a flag without value the text of its
// variable; such a flag is left out.
std::vector<Source> flags_of(const Setting& setting, const CLI::App& app) {
  std::vector<Source> sources;
  for (const std::string_view name : names_of(setting)) {
    const CLI::Option& option = *app.get_option(flag_of(name));
    if (option.count() == 0) continue;
    std::string text;
    for (const std::string& part : option.results()) text += (text.empty() ? "" : ",") + part;
    const char* variable = std::getenv(variable_of(name).c_str());
    if (!variable || text != variable) sources.push_back({flag_of(name), text});
  }
  return sources;
}

// Reads a setting from its flag, else from its variable. Also checks a variable that the flag overrides.
void read_flag(Settings& settings, const Setting& setting, const CLI::App& app,
               std::vector<Problem>& problems) {
  const std::vector<Source> flags = flags_of(setting, app), variables = variables_of(setting);
  Settings overridden;
  for (const Source& source : variables)
    take(flags.empty() ? settings : overridden, setting, source.text, source.place, "", problems);
  for (const Source& source : flags) take(settings, setting, source.text, source.place, "", problems);
  for (const auto& sources : {flags, variables})
    if (sources.size() > 1) problems.push_back(given_twice("", sources[1].place, sources[0].place));
}

void refuse_unknown_variables(std::vector<Problem>& problems) {
  for (char** entry = environ; *entry; ++entry) {
    const std::string_view text(*entry);
    const std::string name(text.substr(0, text.find('=')));
    if (!name.starts_with(kPrefix) || name == kTokenOfClients) continue;
    const bool is_setting =
        std::any_of(all_settings().begin(), all_settings().end(), [&](const Setting& row) {
          const auto names = names_of(row);
          return std::any_of(names.begin(), names.end(),
                             [&](auto known) { return variable_of(known) == name; });
        });
    if (!is_setting) problems.push_back(unknown("", "setting", name, names_as(variable_of)));
  }
}

void refuse_unknown_flags(const std::vector<std::string>& words, const CLI::App& app,
                          std::vector<Problem>& problems) {
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options())
    if (!option->get_group().empty()) known.push_back("--" + option->get_lnames().at(0));
  bool after_flag = false;  // a word after an unknown flag is its value
  for (const std::string& word : words) {
    const std::string name = word.substr(0, word.find('='));
    const bool flag = word.starts_with('-');
    if (flag)
      problems.push_back(unknown("", "option", name, known));
    else if (!after_flag)
      problems.push_back({"", "unknown argument " + shortened(word, 80)});
    after_flag = flag && name == word;
  }
}

}  // namespace

void add_setting_flags(CLI::App& app) {
  app.allow_extras();
  const auto service = all_settings().first(all_settings().size() - limits().size());
  for (const Setting& setting : service) add_flag(app, setting, "Service");
  for (const Setting& setting : limits()) add_flag(app, setting, "Limits");
}

Settings read_settings(const CLI::App& app, const std::string& config_file, std::vector<Problem>& problems) {
  // Reads the file only once, since a pipe cannot be read twice.
  const nlohmann::json file = config_file.empty() ? nullptr : read_file_of_settings(config_file, problems);
  const auto read_over = [&](Settings settings, std::vector<Problem>& found) {
    if (!file.is_null()) read_members(settings, file, config_file, found);
    for (const Setting& setting : all_settings()) read_flag(settings, setting, app, found);
    return settings;
  };
  Settings settings = read_over(Settings(), problems);
  if (settings.memory_bytes != Settings().memory_bytes) {  // other defaults depend on it
    std::vector<Problem> told_already;
    settings = read_over(settings_within(settings.memory_bytes), told_already);
  }
  refuse_unknown_variables(problems);
  refuse_unknown_flags(app.remaining(), app, problems);
  return settings;
}

std::string config_text(const Settings& settings) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  const auto json_of_value = [](const auto& value) -> nlohmann::ordered_json {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, std::chrono::seconds>)
      return value.count();
    else if constexpr (std::is_same_v<Value, double>)
      return static_cast<std::int64_t>(value);
    else
      return value;
  };
  for (const Setting& setting : all_settings())
    json[std::string(setting.name)] =
        std::visit([&](auto member) { return json_of_value(settings.*member); }, setting.member);
  return json.dump(2) + "\n";
}

}  // namespace orrery
