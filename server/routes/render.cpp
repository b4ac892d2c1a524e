#include <array>

#include "server/routes/answers.h"
#include "server/routes/render_body.h"

// POST /v1/render: renders a scene, or a request {scene or scene_id, camera, image, render, budget}.
namespace orrery {
namespace {

struct Kind {
  std::string_view type;
  FileFormat format;
};
constexpr std::array kKinds{Kind{"image/png", FileFormat::png}, Kind{"image/jpeg", FileFormat::jpeg},
                            Kind{"image/x-exr", FileFormat::exr}};

constexpr std::array kTypes{kKinds[0].type, kKinds[1].type, kKinds[2].type};

FileFormat format_of(std::string_view type) {
  for (const Kind& kind : kKinds)
    if (kind.type == type) return kind.format;
  return FileFormat::png;
}

Response render(App& app, Request& request) {
  app.require_open();
  const std::string_view type = negotiate(request, kTypes);
  RequestTrace trace;
  RenderBody body = read_render_body(app, request, trace);
  const RenderOrder order =
      make_order(std::move(body.scene), std::move(body.request), format_of(type), caller_of(request));
  const Rendered rendered = app.renders().render(order, trace);
  Response response = picture_response(type, rendered, trace);
  set_content_location(response, type, order.scene->scene(), *rendered.picture, request.prefix);
  response.set("Orrery-Scene-Id", order.scene->scene().id);
  response.set("Vary", "Accept");
  response.set("Cache-Control", "no-store");
  return response;
}

}  // namespace

void add_render_routes(Router& router, App& app) {
  router
      .add("POST", "/v1/render", Scope::render, LogLevel::info, json_body(app),
           [&app](Request& request) { return render(app, request); })
      .describe({.id = "render",
                 .summary = "Renders a scene",
                 .body = {"application/json", "RenderRequest"},
                 .answers = {{.status = 200,
                              .description = "The image",
                              .headers = {"Server-Timing", "Orrery-Scene-Id", "Content-Location"},
                              .content = {{kTypes[0]}, {kTypes[1]}, {kTypes[2]}},
                              .has_results = true}},
                 .errors = {404, 406}});
}

}  // namespace orrery
