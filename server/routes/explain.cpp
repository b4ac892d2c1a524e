#include "server/api/explain.h"

#include <array>
#include <nlohmann/json.hpp>

#include "core/plan/plan.h"
#include "core/render/views.h"
#include "server/app/app.h"
#include "server/routes/answers.h"

// GET /v1/scenes/{id}/explain: explains what a frame.png with the same query would model and leave out. With
// measure=true, also predicts its cost and error.
namespace orrery {
namespace {

constexpr std::array<std::string_view, 1> kOwnParameters{"measure"};

bool asks_to_measure(const Request& request) {
  const std::string text = find_field(request.query, kOwnParameters[0]).value_or("false");
  if (text != "true" && text != "false")
    throw InputError("/measure", "must be true or false (got " + quoted(text) + ")");
  return text == "true";
}

Response explain(App& app, Request& request) {
  const auto scene = app.scenes().find(request.path_value("id"));
  RenderRequest wanted = read_query(request, kOwnParameters);
  const bool measured = asks_to_measure(request);
  choose_space(wanted, FileFormat::png);
  const SettledPlan plan = app.settle(*scene, make_plan(scene->scene(), wanted), caller_of(request));
  if (!measured) return json_answer(200, explain_json(scene->scene(), *plan));
  Response response =
      json_answer(200, explain_json(scene->scene(), *plan, app.forecast(*scene, plan, caller_of(request))));
  response.set("Cache-Control", "no-store");  // measured times vary
  return response;
}

}  // namespace

void add_explain_routes(Router& router, App& app) {
  router
      .add("GET", "/v1/scenes/{id}/explain", Scope::read, LogLevel::info,
           [&app](Request& request) { return explain(app, request); })
      .describe(
          {.id = "explain",
           .summary = "Returns the plan of an image: each decision with its reason and error bound",
           .parameters = {kSceneId,
                          {kOwnParameters[0], "query",
                           "Whether to trace some pixels and predict the cost and error of the image. The "
                           "request then waits in the queue like a render",
                           R"({"type": "boolean", "default": false})"}},
           .renders = true,
           .answers = {{200, "The plan", {}, {{"application/json", "Explanation"}}}}});
}

}  // namespace orrery
