#include "core/base/hash.h"
#include "core/load/load.h"
#include "server/routes/answers.h"

// GET /schemas/scene.json: the JSON Schema of scenes.
namespace orrery {

void add_schema_routes(Router& router, App&) {
  const std::string schema = scene_schema();
  const std::string etag = "\"" + sha256_hex(schema).substr(0, 32) + "\"";
  router.add("GET", "/schemas/scene.json", Scope::none, LogLevel::info, [schema, etag](Request& request) {
    Response response = has_current(request, etag) ? Response{.status = 304}
                                                   : text_response(200, "application/schema+json", schema);
    response.set("ETag", etag).set("Cache-Control", "no-cache");
    return response;
  });
}

}  // namespace orrery
