#include <nlohmann/json.hpp>

#include "core/stability/registry.h"
#include "server/api/stability_json.h"
#include "server/routes/answers.h"
#include "server/routes/constant.h"

// GET /v1/stability: errors of known numerical methods and of the methods of this build. The first request
// measures them, which takes a third of a second on one thread.
namespace orrery {

void add_stability_routes(Router& router, App&) {
  add_constant(router, "/v1/stability", Scope::read, "application/json",
               [] { return json_answer(200, stability_json(measure_stability())).body; })
      .describe({.id = "get_stability",
                 .summary = "Returns the errors of known numerical methods and of the methods of this build",
                 .etag = Operation::ETag::always,
                 .answers = {{200,
                              "Measured rows; the first request waits for the measurement",
                              {},
                              {{"application/json", "Stability"}}}}});
}

}  // namespace orrery
