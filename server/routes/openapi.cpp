#include "server/routes/openapi.h"

#include <cctype>
#include <nlohmann/json.hpp>
#include <set>

#include "server/api/results.h"
#include "server/app/app.h"
#include "server/routes/constant.h"

// GET /openapi.json: the OpenAPI description of the service, from the operations of the routes.
namespace orrery {
namespace {

using nlohmann::ordered_json;

ordered_json schema_of(Operation::Schema schema) {
  if (schema.starts_with('{')) return ordered_json::parse(schema);
  if (schema.starts_with('/')) return {{"$ref", schema}};
  return component("schemas", schema);
}

ordered_json content_of(std::span<const Operation::Content> contents) {
  ordered_json json = ordered_json::object();
  for (const auto& [type, schema] : contents) {
    ordered_json& content = json[std::string(type)] = ordered_json::object();
    if (!schema.empty()) content["schema"] = schema_of(schema);
  }
  return json;
}

std::string path_of(const Route& route) {
  const std::string_view documented = route.operation->documented_path;
  return documented.empty() ? route.pattern : std::string(documented);
}

ordered_json parameters_of(const Route& route) {
  const Operation& operation = *route.operation;
  ordered_json list = ordered_json::array();
  for (const Operation::Parameter& parameter : operation.parameters) {
    ordered_json& json = list.emplace_back(ordered_json{{"name", parameter.name}, {"in", parameter.in}});
    if (parameter.in == "path") json["required"] = true;
    if (!parameter.description.empty()) json["description"] = parameter.description;
    json["schema"] = schema_of(parameter.schema);
  }
  const auto add_shared = [&](std::string_view name) { list.push_back(component("parameters", name)); };
  if (operation.renders)
    for (ordered_json& option : option_parameters()) list.push_back(std::move(option));
  if (operation.etag != Operation::ETag::none) add_shared("If-None-Match");
  if (route.method == "GET" && route.scope == Scope::read)
    for (const char* name : {"expires", "signature"}) add_shared(name);
  return list;
}

// Returns the statuses of the errors that the route can return, and 304. See Operation.
std::set<int> common_statuses(const Route& route) {
  const Operation& operation = *route.operation;
  std::set<int> statuses(operation.errors.begin(), operation.errors.end());
  if (route.scope != Scope::none) statuses.insert({401, 403});
  if (path_of(route).find('{') != std::string::npos && route.method != "PUT") statuses.insert(404);
  if (route.body) statuses.insert({400, 408, 411, 413, 415, 422, 429, 503, 504});
  if (operation.renders) statuses.insert({400, 422, 429, 503, 504});
  if (operation.etag != Operation::ETag::none) statuses.insert(304);
  statuses.insert(0);
  return statuses;
}

ordered_json response_of(const Operation& operation, const Operation::Answer& answer) {
  ordered_json headers = {{"X-Request-ID", component("headers", "X-Request-ID")}};
  const auto add = [&](std::string_view name) { headers[std::string(name)] = component("headers", name); };
  for (const std::string_view name : answer.headers) add(name);
  if (answer.status == 200 && operation.etag == Operation::ETag::always) add("ETag");
  if (answer.status == 200 && operation.etag == Operation::ETag::if_it_lasts)
    headers["ETag"] = component("headers", "ETag-if-it-lasts");
  for (const ImageResult& row : image_results())
    if (answer.has_results && row.in.image && !row.header.empty()) add(row.header);
  ordered_json json = {{"description", answer.description}, {"headers", std::move(headers)}};
  if (!answer.content.empty()) json["content"] = content_of(answer.content);
  return json;
}

ordered_json responses_of(const Route& route) {
  ordered_json responses = ordered_json::object();
  for (const Operation::Answer& answer : route.operation->answers)
    responses[std::to_string(answer.status)] = response_of(*route.operation, answer);
  const std::set<int> statuses = common_statuses(route);
  for (const CommonResponse& response : common_responses())
    if (statuses.contains(response.status))
      responses[response.status == 0 ? "default" : std::to_string(response.status)] =
          component("responses", response.name);
  return responses;
}

ordered_json operation_of(const Route& route) {
  const Operation& operation = *route.operation;
  ordered_json json = {{"summary", operation.summary}};
  if (!operation.description.empty()) json["description"] = operation.description;
  json["operationId"] = operation.id;
  if (ordered_json parameters = parameters_of(route); !parameters.empty())
    json["parameters"] = std::move(parameters);
  if (!operation.body.type.empty()) {
    if (operation.body_required) json["requestBody"]["required"] = true;
    json["requestBody"]["content"] = content_of({&operation.body, 1});
  }
  json["responses"] = responses_of(route);
  if (route.scope == Scope::none) json["security"] = ordered_json::array();
  return json;
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

std::string openapi_text(const Router& router) {
  ordered_json json = {
      {"openapi", "3.1.0"},
      {"info",
       {{"title", "orrery"},
        {"version", "1"},
        {"description", "Render service for 3D scenes: POST a scene, get an image or a stream of frames."},
        {"license", {{"name", "Apache-2.0"}, {"identifier", "Apache-2.0"}}}}},
      {"servers", ordered_json::array({{{"url", "."}}})},
      {"security", ordered_json::array({{{"bearer", ordered_json::array()}}, ordered_json::object()})}};
  for (const Route& route : router.routes())
    if (route.operation) json["paths"][path_of(route)][lower(route.method)] = operation_of(route);
  json["components"] = openapi_components();
  return json.dump(2) + "\n";
}

void add_openapi_routes(Router& router, App&) {
  add_constant(router, "/openapi.json", Scope::none, "application/json",
               [&router] { return SharedBytes(openapi_text(router)); })
      .describe(
          {.id = "get_description",
           .summary = "Returns this description",
           .etag = Operation::ETag::always,
           .answers = {{200, "This description", {}, {{"application/json", R"({"type": "object"})"}}}}});
}

}  // namespace orrery
