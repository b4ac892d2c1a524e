#include "server/app/app.h"
#include "server/routes/answers.h"

// GET /healthz: the process responds. GET /readyz: the service accepts new work.
namespace orrery {
namespace {

Response status(std::string_view word) {
  Response response = json_response(word == "ok" ? 200 : 503, "{\"status\":\"" + std::string(word) + "\"}\n");
  response.set("Cache-Control", "no-store");
  return response;
}

}  // namespace

void add_health_routes(Router& router, App& app) {
  router.add("GET", "/healthz", Scope::none, LogLevel::debug, [](Request&) { return status("ok"); });
  router.add("GET", "/readyz", Scope::none, LogLevel::debug,
             [&app](Request&) { return status(app.readiness()); });
}

}  // namespace orrery
