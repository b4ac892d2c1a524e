#include "server/app/app.h"
#include "server/http/router.h"
#include "server/routes/answers.h"

// GET /healthz: the process answers. GET /readyz: it takes new work.
namespace orrery {
namespace {

Response status(int code, const char* word) {
  Response response = json_response(code, std::string("{\"status\":\"") + word + "\"}\n");
  response.set("Cache-Control", "no-store");
  return response;
}

}  // namespace

void add_health_routes(Router& router, App& app) {
  router.add("GET", "/healthz", [](Request&) { return status(200, "ok"); });
  router.add("GET", "/readyz", [&app](Request&) {
    if (app.draining()) return status(503, "draining");
    return app.admission().full() ? status(503, "full") : status(200, "ok");
  });
}

}  // namespace orrery
