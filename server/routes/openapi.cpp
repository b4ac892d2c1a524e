#include <algorithm>
#include <nlohmann/json.hpp>

#include "server/api/option_json.h"
#include "server/api/render_options.h"
#include "server/base/embedded.h"
#include "server/config/settings.h"
#include "server/routes/answers.h"
#include "server/routes/constant.h"

// GET /openapi.json: the OpenAPI description of the service. The file openapi.json contains everything except
// the parts that follow from render options and settings:
//   "render options" in a list of parameters  is replaced by the query parameters of all render options;
//   components.schemas                        lacks the sections of a request body, such as camera;
//   components.schemas.Explanation            lacks the options of the section render;
//   components.schemas.Limits                 lacks the limits that are settings.
namespace orrery {
namespace {

using nlohmann::ordered_json;

constexpr std::string_view kPlaceholder = "render options";

ordered_json file_part() {
  const auto files = embedded_files();
  const auto file = std::find_if(files.begin(), files.end(),
                                 [](const auto& f) { return f.path == "server/routes/openapi.json"; });
  return ordered_json::parse(file->bytes);
}

// Returns the query parameter `name` of an option. The values of a list are separated by commas.
ordered_json parameter_of(std::string_view name, const RenderOption& option, ordered_json schema) {
  std::string description = schema["description"];
  schema.erase("description");
  if (name != option.key) description = "Short name of " + std::string(option.key) + ".";
  ordered_json parameter = {{"name", name}, {"in", "query"}, {"description", std::move(description)}};
  const auto form = option.form();
  if (form == RenderOption::Form::numbers || form == RenderOption::Form::strings)
    parameter.update({{"style", "form"}, {"explode", false}});
  parameter["schema"] = std::move(schema);
  return parameter;
}

void add_schemas(ordered_json& schemas, const ordered_json& options) {
  for (const Section section : kSections) {
    ordered_json& schema = schemas[std::string(name_of(section))];
    schema = {{"type", "object"}, {"properties", ordered_json::object()}, {"additionalProperties", false}};
    for (const RenderOption& option : render_options())
      if (option.section == section) schema["properties"][std::string(option.key)] = options.at(option.key);
  }
  schemas["Explanation"]["properties"].update(schemas["render"]["properties"]);
}

void add_limits(ordered_json& schema) {
  for (const Setting& limit : limits()) {
    schema["required"].push_back(limit.name);
    schema["properties"][std::string(limit.name)] = {
        {"type", "integer"}, {"minimum", limit.min}, {"description", std::string(limit.help) + "."}};
  }
}

// Replaces the placeholder in all lists of parameters with references to components. Returns these components
// by name.
ordered_json expand_parameters(ordered_json& paths, const ordered_json& options) {
  ordered_json components = ordered_json::object(), references = ordered_json::array();
  for (const std::string_view name : render_option_names()) {
    const RenderOption& option = *find_render_option(name);
    const std::string component = "query-" + std::string(name);
    components[component] = parameter_of(name, option, options.at(option.key));
    references.push_back({{"$ref", "#/components/parameters/" + component}});
  }
  for (ordered_json& path : paths) {
    if (!path.contains("get")) continue;
    ordered_json expanded = ordered_json::array();
    for (const ordered_json& parameter : path["get"].value("parameters", ordered_json::array())) {
      if (parameter == kPlaceholder)
        expanded.insert(expanded.end(), references.begin(), references.end());
      else
        expanded.push_back(parameter);
    }
    if (!expanded.empty()) path["get"]["parameters"] = std::move(expanded);
  }
  return components;
}

std::string description() {
  ordered_json json = file_part();
  const ordered_json options = option_schemas();
  add_schemas(json["components"]["schemas"], options);
  add_limits(json["components"]["schemas"]["Limits"]);
  json["components"]["parameters"].update(expand_parameters(json["paths"], options));
  return json.dump(2) + "\n";
}

}  // namespace

void add_openapi_routes(Router& router, App&) {
  add_constant(router, "/openapi.json", Scope::none, "application/json",
               [] { return SharedBytes(description()); });
}

}  // namespace orrery
