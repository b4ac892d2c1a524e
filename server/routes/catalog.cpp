#include "server/api/catalog.h"

#include <nlohmann/json.hpp>

#include "server/routes/answers.h"
#include "server/routes/constant.h"

// GET /v1/catalog: all names that scenes and requests can use.
namespace orrery {

void add_catalog_routes(Router& router, App&) {
  add_constant(router, "/v1/catalog", Scope::read, "application/json",
               [] { return json_answer(200, catalog_json()).body; })
      .describe({.id = "get_catalog",
                 .summary = "Returns the types that scenes and requests can use, and the sample scenes",
                 .etag = Operation::ETag::always,
                 .answers = {{200, "Types and samples", {}, {{"application/json", "Catalog"}}}}});
}

}  // namespace orrery
