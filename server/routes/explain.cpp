#include "server/app/explain.h"

#include <nlohmann/json.hpp>

#include "core/plan/plan.h"
#include "server/app/app.h"
#include "server/http/router.h"
#include "server/routes/answers.h"

// GET /v1/scenes/{id}/explain: what a frame.png with the same query would model, and why no more.
namespace orrery {

void add_explain_routes(Router& router, App& app) {
  router.add("GET", "/v1/scenes/{id}/explain", [&app](Request& request) {
    const auto scene = app.scenes().find(request.path_value("id"));
    Plan plan = make_plan(scene->scene(), read_query(request));
    app.settle(*scene, plan, caller_of(request));
    return json_answer(200, explain_json(scene->scene(), plan));
  });
}

}  // namespace orrery
