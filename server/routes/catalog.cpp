#include "server/app/catalog.h"

#include <nlohmann/json.hpp>

#include "server/routes/answers.h"

// GET /v1/catalog: all that scenes and requests can name.
namespace orrery {

void add_catalog_routes(Router& router, App&) {
  router.add("GET", "/v1/catalog", Scope::read, LogLevel::info,
             [](Request&) { return json_answer(200, catalog_json()); });
}

}  // namespace orrery
