#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "server/api/option_json.h"
#include "server/api/render_options.h"
#include "server/api/results.h"
#include "server/base/embedded.h"
#include "server/routes/limits.h"
#include "server/routes/openapi.h"

// Shared parts of the OpenAPI description. The file schemas.json contains the schemas, except these parts:
//   sections of a request body, such as camera, and the options in Explanation   follow from render options;
//   limits in Limits                                                            follow from limits.cpp;
//   results of images                                                           follow from the result table.
namespace orrery {
namespace {

using nlohmann::ordered_json;

constexpr std::array kResponses{
    CommonResponse{304, "NotModified", "The client has the current version", "ETag"},
    CommonResponse{400, "Malformed",
                   "The request or its JSON is malformed; offset, line and column locate the error"},
    CommonResponse{401, "Unauthorized", "The token is missing or unknown", "WWW-Authenticate"},
    CommonResponse{403, "Forbidden", "The token lacks the scope, or the link is invalid or expired"},
    CommonResponse{404, "NotFound", "The resource does not exist or was removed"},
    CommonResponse{406, "NotAcceptable", "No available format matches Accept"},
    CommonResponse{408, "Timeout", "The request was not received in time"},
    CommonResponse{409, "Conflict", "The resource is not ready yet"},
    CommonResponse{411, "LengthRequired", "A body requires Content-Length"},
    CommonResponse{413, "TooLarge", "The body exceeds the named limit"},
    CommonResponse{415, "MediaType", "The media type or content coding of the body is not supported"},
    CommonResponse{
        422, "Invalid",
        "The input is invalid. errors lists up to 20 places and reasons. Also returned for an image "
        "whose estimated rays exceed request_rays; POST /v1/jobs accepts such an image"},
    CommonResponse{429, "ClientBusy", "The client has reached its share of a limit", "Retry-After"},
    CommonResponse{503, "Busy", "A limit of the service is reached, or the service is shutting down",
                   "Retry-After"},
    CommonResponse{504, "TookTooLong", "The request took longer than request_seconds"},
    CommonResponse{0, "Problem", "Any other error"},
};

struct Header {
  std::string_view name, description;
  std::string_view schema = R"({"type": "string"})";
  bool always = true;  // present in each response that lists it
};
constexpr std::array kHeaders{
    Header{"ETag", "Strong validator"},
    Header{
        "ETag-if-it-lasts",
        "Strong validator. Absent for an image with a time budget or a missed budget, because another render "
        "may be better",
        R"({"type": "string"})", false},
    Header{"Location", "Path of the resource"},
    Header{"Content-Location", "URL that renders the same bytes without a budget",
           R"({"type": "string", "format": "uri-reference"})", false},
    Header{"Cache-Control", "Cache policy of the response"},
    Header{
        "Server-Timing",
        "Milliseconds of the steps queue, load, plan, build, render and encode. Size and work counts of the "
        "acceleration structure"},
    Header{
        "Orrery-Scene-Id",
        "Id of the scene: the SHA-256 of its canonical JSON. The scene is cached at /v1/scenes/{id} unless "
        "stored scenes leave too little memory. While it is cached, it can be rendered again by this id"},
    Header{"Orrery-Asset-Id", "Id of the stored asset: the SHA-256 of its bytes"},
    Header{"Orrery-Model-Notes", "Contents of the model that are not modelled, and repairs",
           R"({"type": "string"})", false},
    Header{"Retry-After",
           "Seconds to wait before a retry. For a full queue: queued work divided by the measured throughput",
           R"({"type": "integer"})"},
    Header{"X-Request-ID", "Id from the request, or a generated id"},
    Header{"Allow", "Allowed methods"},
    Header{"WWW-Authenticate", "Authentication scheme: Bearer"},
};

ordered_json header_components() {
  ordered_json headers = ordered_json::object();
  for (const Header& header : kHeaders) {
    ordered_json& json = headers[std::string(header.name)] = {{"description", header.description}};
    if (!header.always) json["required"] = false;
    json["schema"] = ordered_json::parse(header.schema);
  }
  for (const ImageResult& row : image_results())
    if (!row.header.empty())
      headers[std::string(row.header)] = {
          {"description", row.description}, {"required", false}, {"schema", {{"type", row.header_type}}}};
  return headers;
}

ordered_json response_components() {
  ordered_json responses = ordered_json::object();
  for (const CommonResponse& response : kResponses) {
    ordered_json headers = {{"X-Request-ID", component("headers", "X-Request-ID")}};
    if (!response.header.empty())
      headers[std::string(response.header)] = component("headers", response.header);
    const bool is_error = response.status != 304;
    if (!is_error) headers["Cache-Control"] = component("headers", "Cache-Control");
    ordered_json& json = responses[std::string(response.name)] = {{"description", response.description},
                                                                  {"headers", std::move(headers)}};
    if (is_error) json["content"]["application/problem+json"]["schema"] = component("schemas", "Problem");
  }
  return responses;
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

std::string component_of_option(std::string_view name) { return "query-" + std::string(name); }

ordered_json parameter_components(const ordered_json& options) {
  ordered_json parameters = {
      {"expires",
       {{"name", "expires"},
        {"in", "query"},
        {"description", "Expiry of a signed link, in seconds since 1970"},
        {"schema", {{"type", "integer"}}}}},
      {"signature",
       {{"name", "signature"},
        {"in", "query"},
        {"description", "Signature of a signed link"},
        {"schema", {{"type", "string"}}}}},
      {"If-None-Match", {{"name", "If-None-Match"}, {"in", "header"}, {"schema", {{"type", "string"}}}}}};
  for (const std::string_view name : render_option_names()) {
    const RenderOption& option = *find_render_option(name);
    parameters[component_of_option(name)] = parameter_of(name, option, options.at(option.key));
  }
  return parameters;
}

ordered_json results_schema(ResultOutput output) {
  ordered_json schema = {{"type", "object"}, {"properties", ordered_json::object()}};
  for (const ImageResult& row : image_results())
    if (row.in.*output && !row.member.empty())
      schema["properties"][std::string(row.member)] = {{"type", row.member_type},
                                                       {"description", row.description}};
  return schema;
}

ordered_json schema_components(const ordered_json& options) {
  const auto files = embedded_files();
  const auto file = std::find_if(files.begin(), files.end(),
                                 [](const auto& f) { return f.path == "server/routes/schemas.json"; });
  ordered_json schemas = ordered_json::parse(file->bytes);
  for (const Section section : kSections) {
    ordered_json& schema = schemas[std::string(name_of(section))];
    schema = {{"type", "object"}, {"properties", ordered_json::object()}, {"additionalProperties", false}};
    for (const RenderOption& option : render_options())
      if (option.section == section) schema["properties"][std::string(option.key)] = options.at(option.key);
  }
  schemas["Explanation"]["properties"].update(schemas["render"]["properties"]);
  add_limit_schemas(schemas["Limits"]);
  schemas["OrbitResults"] = results_schema(&ResultOutputs::orbit_frame);
  schemas["RefinementResults"] = results_schema(&ResultOutputs::refinement_frame);
  schemas["JobFrameResults"] = results_schema(&ResultOutputs::job_step);
  return schemas;
}

}  // namespace

std::span<const CommonResponse> common_responses() { return kResponses; }

ordered_json component(std::string_view kind, std::string_view name) {
  return {{"$ref", "#/components/" + std::string(kind) + "/" + std::string(name)}};
}

ordered_json option_parameters() {
  ordered_json references = ordered_json::array();
  for (const std::string_view name : render_option_names())
    references.push_back(component("parameters", component_of_option(name)));
  return references;
}

ordered_json openapi_components() {
  const ordered_json options = option_schemas();
  return {{"schemas", schema_components(options)},
          {"parameters", parameter_components(options)},
          {"headers", header_components()},
          {"responses", response_components()},
          {"securitySchemes",
           {{"bearer",
             {{"type", "http"},
              {"scheme", "bearer"},
              {"description", "Required under /v1/ if the service runs with --tokens-file"}}}}}};
}

}  // namespace orrery
