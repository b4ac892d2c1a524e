#include "core/load/load.h"
#include "server/app/app.h"
#include "server/routes/constant.h"

// GET /schemas/scene.json: the JSON Schema of scenes.
namespace orrery {

void add_schema_routes(Router& router, App&) {
  add_constant(router, "/schemas/scene.json", Scope::none, "application/schema+json",
               [] { return SharedBytes(scene_schema()); })
      .describe(
          {.id = "get_scene_schema",
           .summary = "Returns the JSON Schema of scenes",
           .etag = Operation::ETag::always,
           .answers = {{200, "The schema", {}, {{"application/schema+json", R"({"type": "object"})"}}}}});
}

}  // namespace orrery
