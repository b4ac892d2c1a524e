#include <nlohmann/json.hpp>

#include "core/base/work_scope.h"
#include "core/stability/registry.h"
#include "server/app/stability_json.h"
#include "server/routes/answers.h"

// GET /v1/stability: where known numerical methods fail, and what this build's are off.
namespace orrery {
namespace {

// The same for every request of this build: measured for the first, a third of a second on one thread, and
// kept.
const nlohmann::ordered_json& measured_once() {
  static const nlohmann::ordered_json json = [] {
    const WorkScope nobody({});  // whose request is the first is chance
    return stability_json(measure_stability());
  }();
  return json;
}

}  // namespace

void add_stability_routes(Router& router, App&) {
  router.add("GET", "/v1/stability", Scope::read, LogLevel::info,
             [](Request&) { return json_answer(200, measured_once()); });
}

}  // namespace orrery
