#include "server/routes/limits.h"

#include <nlohmann/json.hpp>

#include "core/image/decode/picture.h"
#include "core/params/motion.h"
#include "core/plan/limits.h"
#include "core/study/study.h"
#include "server/api/option_json.h"
#include "server/http/framing_check.h"
#include "server/routes/answers.h"
#include "server/routes/constant.h"

// GET /v1/limits: the limits of requests, under the names that errors use.
namespace orrery {
namespace {

// Returns the JSON Schema of each render option, such as {"minimum": 1, "maximum": 32}, without description.
nlohmann::ordered_json option_limits() {
  nlohmann::ordered_json limits = option_schemas();
  for (auto& schema : limits) schema.erase("description");
  return limits;
}

// Returns the limits that no setting changes.
nlohmann::ordered_json fixed_limits() {
  return {{"head_bytes", kMaxHeadBytes},
          {"header_bytes", kMaxHeaderBytes},
          {"address_bytes", kMaxTargetBytes},
          {"json_depth", JsonLimits{}.depth},
          {"json_nodes", JsonLimits{}.nodes},
          {"image_side", kMaxImageSide},
          {"image_pixels", kMaxImagePixels},
          {"samples", kMaxSamples},
          {"ray_depth", kMaxDepth},
          {"chart_pixels", kMaxChartPixels},
          {"chart_samples", kMaxChartSamples},
          {"chart_rounds", kMaxChartRounds},
          {"objects", kMaxObjects},
          {"lights", kMaxLights},
          {"textures", kMaxTextures},
          {"texture_texels", kMaxTextureTexels},
          {"instanced_primitives", kMaxInstanced},
          {"motion_keys", kMaxKeys},
          {"mesh_vertices", MeshLimits{}.vertices},
          {"mesh_triangles", MeshLimits{}.triangles},
          {"picture_side", PictureLimits{}.side},
          {"picture_texels", PictureLimits{}.texels}};
}

nlohmann::ordered_json limits_json(const Settings& settings, const nlohmann::ordered_json& options) {
  nlohmann::ordered_json json = fixed_limits();
  for (const Setting& limit : limits()) json[std::string(limit.name)] = std::stoll(limit.text(settings));
  json["work_bytes"] = work_bytes(settings);
  json["storage"] = "memory";  // scenes, assets, images and jobs are lost when the service stops
  json["options"] = options;
  return json;
}

}  // namespace

void add_limit_schemas(nlohmann::ordered_json& schema) {
  const auto add = [&](std::string_view name, nlohmann::ordered_json&& limit) {
    schema["required"].push_back(name);
    schema["properties"][std::string(name)] = std::move(limit);
  };
  const nlohmann::ordered_json fixed = fixed_limits();
  for (const auto& [name, value] : fixed.items()) add(name, {{"type", "integer"}, {"minimum", 0}});
  add("work_bytes", {{"type", "integer"}, {"minimum", 0}});
  for (const Setting& limit : limits())
    add(limit.name,
        {{"type", "integer"}, {"minimum", limit.min}, {"description", std::string(limit.help) + "."}});
}

void add_limits_routes(Router& router, App& app) {
  add_constant(router, "/v1/limits", Scope::read, "application/json",
               [&app] { return json_answer(200, limits_json(app.settings(), option_limits())).body; })
      .describe({.id = "get_limits",
                 .summary = "Returns the limits of requests, under the names that errors use",
                 .etag = Operation::ETag::always,
                 .answers = {{200, "Limits", {}, {{"application/json", "Limits"}}}}});
}

}  // namespace orrery
