#include <array>

#include "core/load/load.h"
#include "core/plan/plan.h"
#include "server/app/app.h"
#include "server/http/router.h"
#include "server/routes/answers.h"

// POST /v1/render: a scene, or a request {scene or scene_id, camera, image, render}, to a picture.
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

struct Order {
  SceneStore::Prepared scene;
  RenderRequest request;
};

// A document with neither scene nor scene_id is a scene itself.
Order read_order(App& app, const Document& document, Timing& timing) {
  const auto prepare = [&](const Document& scene) {
    return std::make_shared<const PreparedScene>(app.load(scene, timing));
  };
  const auto scene = document.member("scene");
  const auto id = document.member("scene_id");
  if (!scene && !id) return {prepare(document), {}};
  if (scene && id) throw InputError("/scene_id", "expected either scene or scene_id, got both");
  Order order{{}, read_request(document)};
  if (scene) {
    order.scene = prepare(*scene);
  } else {
    const std::string text = id->canonical();  // in quotes if it is one
    if (!text.starts_with('"'))
      throw InputError("/scene_id", "expected the id of a scene in quotes, got " + text.substr(0, 40));
    order.scene = app.scenes().find(text.substr(1, text.size() - 2));
  }
  return order;
}

Response render(App& app, Request& request) {
  app.require_open();
  constexpr std::array kTypes{kKinds[0].type, kKinds[1].type, kKinds[2].type};
  const std::string_view type = negotiate(request, kTypes);
  Timing timing;
  auto start = Clock::now();
  const Document document = read_json(request);
  timing.load = milliseconds_since(start);
  const Order order = read_order(app, document, timing);
  start = Clock::now();
  const Plan plan = make_plan(order.scene->scene(), order.request);
  timing.plan = milliseconds_since(start);
  Picture picture = app.render(*order.scene, plan, format_of(type), request.gone, timing);
  Response response = text_response(200, type, std::move(picture.bytes));
  tell_work(response, timing, picture.stats);
  response.set("Vary", "Accept");
  response.set("Cache-Control", "no-store");
  return response;
}

}  // namespace

void add_render_routes(Router& router, App& app) {
  router.add("POST", "/v1/render", [&app](Request& request) { return render(app, request); });
}

}  // namespace orrery
