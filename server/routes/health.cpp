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
  const Operation::Content health{"application/json", "Health"};
  router.add("GET", "/healthz", Scope::none, LogLevel::debug, [](Request&) { return status("ok"); })
      .describe({.id = "healthz",
                 .summary = "Reports whether the process responds",
                 .answers = {{200, "The process responds", {}, {health}}}});
  router
      .add("GET", "/readyz", Scope::none, LogLevel::debug,
           [&app](Request&) { return status(app.readiness()); })
      .describe(
          {.id = "readyz",
           .summary = "Reports whether load balancers should send new work",
           .answers = {{200, "Send new work", {}, {health}},
                       {503, "Send no new work: the service is full, slow or draining", {}, {health}}}});
}

}  // namespace orrery
