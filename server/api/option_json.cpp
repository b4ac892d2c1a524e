#include "server/api/option_json.h"

#include <nlohmann/json.hpp>

#include "core/load/load.h"

namespace orrery {
namespace {

using nlohmann::ordered_json;

void add_value(ordered_json& json, const RenderOption& option, const RenderSettings& settings) {
  json[std::string(option.key)] = ordered_json::parse(option.text(settings));
}

}  // namespace

ordered_json section_json(const RenderSettings& settings, Section section) {
  ordered_json json = ordered_json::object();
  for (const RenderOption& option : render_options())
    if (option.section == section) add_value(json, option, settings);
  return json;
}

ordered_json options_json(const RenderSettings& settings) {
  ordered_json json = ordered_json::object();
  for (const RenderOption& option : render_options()) add_value(json, option, settings);
  return json;
}

ordered_json option_schemas() {
  const ordered_json request = ordered_json::parse(request_schema());
  ordered_json schemas = ordered_json::object();
  for (const RenderOption& option : render_options()) {
    const std::string key(option.key), section(name_of(option.section));
    ordered_json schema = request["properties"][section]["properties"][key];
    std::string description = schema["description"];
    if (option.in_scene && !option.by_technique)
      description += " Default: that of the scene, else " + option.text(default_settings()) + ".";
    if (!option.changes_pixels) description += " Does not change pixels.";
    if (schema.contains("$ref")) {  // only the request schema contains the shared definitions
      const std::string reference = schema["$ref"];
      schema.erase("$ref");
      schema.update(request.at(ordered_json::json_pointer(reference.substr(1))));
    }
    schema["description"] = std::move(description);
    schemas[key] = std::move(schema);
  }
  return schemas;
}

}  // namespace orrery
