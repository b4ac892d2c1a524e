#include <nlohmann/json.hpp>

#include "core/params/motion.h"
#include "core/plan/limits.h"
#include "server/http/head.h"
#include "server/http/router.h"
#include "server/routes/answers.h"

// GET /v1/limits: what no request may exceed, under the names that errors use.
namespace orrery {
namespace {

nlohmann::ordered_json limits_json(const Settings& settings) {
  return {{"body_bytes", settings.body_bytes},
          {"bodies_bytes", settings.bodies_bytes},
          {"head_bytes", kMaxHeadBytes},
          {"address_bytes", kMaxTargetBytes},
          {"json_depth", JsonLimits{}.depth},
          {"json_nodes", JsonLimits{}.nodes},
          {"image_side", kMaxImageSide},
          {"image_pixels", kMaxImagePixels},
          {"samples", kMaxSamples},
          {"ray_depth", kMaxDepth},
          {"objects", kMaxObjects},
          {"lights", kMaxLights},
          {"orbit_frames", settings.orbit_frames},
          {"orbits", settings.orbits},
          {"request_seconds", settings.request_time.count()},
          {"queue", settings.queue},
          {"connections", settings.connections},
          {"store_bytes", settings.store_bytes},
          {"asset_bytes", settings.asset_bytes},
          {"asset_store_bytes", settings.asset_store_bytes},
          {"instanced_primitives", kMaxInstanced},
          {"motion_keys", kMaxKeys},
          {"mesh_vertices", MeshLimits{}.vertices},
          {"mesh_triangles", MeshLimits{}.triangles}};
}

}  // namespace

void add_limits_routes(Router& router, App& app) {
  router.add("GET", "/v1/limits", [&app](Request&) { return json_answer(200, limits_json(app.settings())); });
}

}  // namespace orrery
