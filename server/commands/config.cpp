#include "server/commands/config.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/params/json.h"
#include "core/params/suggest.h"
#include "server/commands/scene_file.h"

namespace orrery {
namespace {

constexpr const char *kService = "Service", *kLimits = "Limits";

std::string flag_of(std::string_view name) {
  std::string flag = "--" + std::string(name);
  std::replace(flag.begin(), flag.end(), '_', '-');
  return flag;
}

std::string variable_of(std::string_view name) {
  std::string variable = "ORRERY_" + std::string(name);
  std::transform(variable.begin(), variable.end(), variable.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return variable;
}

std::string name_of(const CLI::Option& option) {
  std::string name = option.get_lnames().at(0);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

std::vector<CLI::Option*> settings_of(const CLI::App& app) {
  std::vector<CLI::Option*> options;
  for (const CLI::Option* option : app.get_options())
    if (option->get_group() == kService || option->get_group() == kLimits)
      options.push_back(const_cast<CLI::App&>(app).get_option("--" + option->get_lnames().at(0)));
  return options;
}

template <class Value>
CLI::Option* add(CLI::App& app, const char* name, Value& value, const char* type, const char* help) {
  return app.add_option(flag_of(name), value, help)
      ->type_name(type)
      ->envname(variable_of(name))
      ->group(kService);
}

void add_limit(CLI::App& app, const Limit& limit, Settings& settings) {
  CLI::Option* option = app.add_option_function<std::int64_t>(
      flag_of(limit.name), [&limit, &settings](std::int64_t value) { limit.set(settings, value); },
      std::string(limit.help));
  option->check(CLI::Range(limit.min, limit.max).description(""))
      ->type_name("N")
      ->envname(variable_of(limit.name))
      ->default_str(std::to_string(static_cast<std::int64_t>(limit.value(settings))))
      ->group(kLimits);
}

// A value in a file as the texts that its flag would have.
std::vector<std::string> texts_of(const nlohmann::json& value, bool list) {
  if (value.is_string()) return {value.get<std::string>()};
  if (value.is_number_float() && std::trunc(value.get<double>()) == value.get<double>() &&
      std::abs(value.get<double>()) < 1e15)
    return {std::to_string(value.get<std::int64_t>())};  // 1e6 is a whole number
  if (value.is_boolean() || value.is_number()) return {value.dump()};
  if (!list || !value.is_array())
    throw InputError(
        "", list ? "expected a text or a list of texts" : "expected a number, a text, true or false");
  std::vector<std::string> texts;
  for (const auto& entry : value) {
    if (!entry.is_string()) throw InputError("", "expected a list of texts");
    texts.push_back(entry.get<std::string>());
  }
  return texts;
}

void take(CLI::Option& option, const nlohmann::json& value) {
  const std::vector<std::string> texts = texts_of(value, option.get_delimiter() != '\0');
  if (option.count() > 0 || texts.empty()) return;
  for (const std::string& text : texts) option.add_result(text);
  try {
    option.run_callback();
  } catch (const CLI::ParseError& error) {
    throw InputError("", error.what());
  }
}

nlohmann::ordered_json json_of_text(const std::string& text) {
  const auto value = nlohmann::json::parse(text, nullptr, false);
  if (value.is_number() || value.is_boolean()) return value;
  return text;
}

}  // namespace

void add_settings(CLI::App& app, Settings& settings) {
  const auto port = CLI::Range(0, 65535).description("");
  add(app, "host", settings.host, "NAME", "Name or address to listen on")->capture_default_str();
  add(app, "port", settings.port, "N", "Port; 0: a free one")->check(port)->capture_default_str();
  add(app, "health_port", settings.health_port, "N",
      "Port of /healthz, /readyz and /metrics, which answer however busy the service is; 0: a free one")
      ->check(port)
      ->capture_default_str();
  add(app, "threads", settings.threads, "N", "Threads that render; 0: one a core")
      ->check(CLI::Range(0, 1024).description(""))
      ->capture_default_str();
  add(app, "tokens_file", settings.tokens_file, "FILE",
      "Who may use the service: lines of `orrery token`; read again on SIGHUP");
  add(app, "share_key_file", settings.share_key_file, "FILE",
      "At least 32 secret bytes that links are signed with (POST /v1/shares); read again on SIGHUP");
  add(app, "cors_origins", settings.cors_origins, "ORIGIN,...",
      "Origins whose pages may use the service, also its own if that is a domain and there are no "
      "tokens; * for all")
      ->delimiter(',');
  app.add_flag("--insecure", settings.insecure,
               "Allow an address that other machines can reach without tokens")
      ->envname(variable_of("insecure"))
      ->group(kService);
  for (const Limit& limit : limits()) add_limit(app, limit, settings);
}

void read_config_file(CLI::App& app, const std::string& path) {
  const auto fail = [&](const std::string& place, const std::string& detail) {
    throw InputError(path, (place.empty() ? "" : place + ": ") + detail);
  };
  const Document document = [&] {
    try {
      return parse_document(read_file(path));
    } catch (const InputError& error) {
      throw InputError(path, error.what());
    }
  }();
  const nlohmann::json& json = json_of(document);
  if (!json.is_object()) fail("", "expected an object");
  const std::vector<CLI::Option*> options = settings_of(app);
  std::vector<std::string> names;
  for (const CLI::Option* option : options) names.push_back(name_of(*option));
  const std::vector<std::string_view> known(names.begin(), names.end());
  for (const auto& [name, value] : json.items()) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) fail("/" + name.substr(0, 80), "unknown key" + did_you_mean(name, known));
    try {
      take(*options[static_cast<std::size_t>(found - names.begin())], value);
    } catch (const InputError& error) {
      fail("/" + name, error.problems()[0].detail);
    }
  }
}

std::string config_text(const CLI::App& app) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const CLI::Option* option : settings_of(app)) {
    auto& value = json[name_of(*option)];
    if (option->get_delimiter() != '\0') {
      value = option->reduced_results();
    } else if (option->get_expected_max() == 0) {
      value = option->count() > 0 && option->as<bool>();
    } else {
      value = json_of_text(option->count() > 0 ? option->results().back() : option->get_default_str());
    }
  }
  return json.dump(2) + "\n";
}

}  // namespace orrery
