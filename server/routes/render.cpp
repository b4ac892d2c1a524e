#include <array>

#include "core/plan/plan.h"
#include "server/rendering/picture_key.h"
#include "server/routes/answers.h"
#include "server/routes/render_order.h"

// POST /v1/render: renders a scene, or a request {scene or scene_id, camera, image, render, budget}.
namespace orrery {
namespace {

struct Kind {
  std::string_view type;
  FileFormat format;
};
constexpr std::array kKinds{Kind{"image/png", FileFormat::png}, Kind{"image/jpeg", FileFormat::jpeg},
                            Kind{"image/x-exr", FileFormat::exr}};

FileFormat format_of(std::string_view type) {
  for (const Kind& kind : kKinds)
    if (kind.type == type) return kind.format;
  return FileFormat::png;
}

Response render(App& app, Request& request) {
  app.require_open();
  constexpr std::array kTypes{kKinds[0].type, kKinds[1].type, kKinds[2].type};
  const std::string_view type = negotiate(request, kTypes);
  Timing timing;
  RenderOrder order = read_render_order(app, request, timing);
  require_layers_kept(order.request, format_of(type));
  choose_space(order.request, format_of(type));
  const auto start = Clock::now();
  const Plan plan = make_plan(order.scene->scene(), order.request);
  timing.plan = milliseconds_since(start);
  const Rendered rendered = app.render(*order.scene, plan, work_key(order.scene->scene(), order.request),
                                       format_of(type), caller_of(request), timing);
  Response response = picture_response(type, rendered, timing);
  set_budget(response, type, order.scene->scene(), *rendered.picture, request.prefix);
  response.set("Orrery-Scene-Id", order.scene->scene().id);
  response.set("Vary", "Accept");
  response.set("Cache-Control", "no-store");
  return response;
}

}  // namespace

void add_render_routes(Router& router, App& app) {
  router.add("POST", "/v1/render", Scope::render, LogLevel::info, json_body(app),
             [&app](Request& request) { return render(app, request); });
}

}  // namespace orrery
