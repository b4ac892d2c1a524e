#include "core/load/load.h"
#include "server/app/app.h"
#include "server/routes/constant.h"

// GET /schemas/scene.json: the JSON Schema of scenes.
namespace orrery {

void add_schema_routes(Router& router, App&) {
  add_constant(router, "/schemas/scene.json", Scope::none, "application/schema+json",
               [] { return SharedBytes(scene_schema()); });
}

}  // namespace orrery
