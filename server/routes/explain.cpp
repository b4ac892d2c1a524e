#include "server/app/explain.h"

#include <nlohmann/json.hpp>

#include "core/plan/plan.h"
#include "core/render/views.h"
#include "server/app/app.h"
#include "server/routes/answers.h"

// GET /v1/scenes/{id}/explain: what a frame.png with the same query would model, and why no more.
namespace orrery {

void add_explain_routes(Router& router, App& app) {
  router.add("GET", "/v1/scenes/{id}/explain", Scope::read, LogLevel::info, [&app](Request& request) {
    const auto scene = app.scenes().find(request.path_value("id"));
    RenderRequest wanted = read_query(request);
    choose_space(wanted, FileFormat::png);
    const SettledPlan plan = app.settle(*scene, make_plan(scene->scene(), wanted), caller_of(request));
    return json_answer(200, explain_json(scene->scene(), *plan));
  });
}

}  // namespace orrery
