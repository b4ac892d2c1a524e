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

nlohmann::ordered_json limits_json(const Settings& settings, const nlohmann::ordered_json& options) {
  nlohmann::ordered_json json = {{"head_bytes", kMaxHeadBytes},
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
                                 {"instanced_primitives", kMaxInstanced},
                                 {"motion_keys", kMaxKeys},
                                 {"mesh_vertices", MeshLimits{}.vertices},
                                 {"mesh_triangles", MeshLimits{}.triangles},
                                 {"picture_side", PictureLimits{}.side},
                                 {"picture_texels", PictureLimits{}.texels}};
  for (const Setting& limit : limits()) json[std::string(limit.name)] = std::stoll(limit.text(settings));
  json["work_bytes"] = work_bytes(settings);
  json["storage"] = "memory";  // scenes, assets, images and jobs are lost when the service stops
  json["options"] = options;
  return json;
}

}  // namespace

void add_limits_routes(Router& router, App& app) {
  add_constant(router, "/v1/limits", Scope::read, "application/json",
               [&app] { return json_answer(200, limits_json(app.settings(), option_limits())).body; })
      .describe({.id = "get_limits",
                 .summary = "Returns the limits of requests, under the names that errors use",
                 .etag = Operation::ETag::always,
                 .answers = {{200, "Limits", {}, {{"application/json", "Limits"}}}}});
}

}  // namespace orrery
