#include "server/routes/frame.h"

#include "server/rendering/picture_key.h"

// GET /v1/scenes/{id}/frame.png: one image, a pure function of its URL unless the URL sets a time budget.
namespace orrery {

Response frame_response(App& app, const Request& request, const RenderOrder& order, RequestTrace& trace,
                        std::string_view cache_control) {
  const Scene& scene = order.scene->scene();
  const RenderRequest& wanted = order.request;

  Response response;
  const std::string etag = etag_of(scene, wanted);
  bool lasts = wanted.seconds.value_or(0) == 0;
  // An image that missed its budget has no ETag. An ETag from the client therefore proves a met budget, but
  // "*" does not.
  const bool named = !has_budget(wanted) || request.header("If-None-Match") != "*";
  if (lasts && named && has_current(request, etag)) {
    response.status = 304;
  } else if (request.method == "HEAD") {
    response.set("Content-Type", "image/png");
    lasts = lasts && !has_budget(wanted);
  } else {
    const Rendered rendered = app.renders().render(order, trace);
    response = picture_response("image/png", rendered, trace);
    set_content_location(response, "image/png", scene, *rendered.picture, request.prefix);
    // Another instance may have a higher limit on rays and meet the budget.
    lasts = lasts && !is_missed(rendered.picture->budget);
  }
  if (!lasts) return response.set("Cache-Control", "no-store");
  response.set("ETag", etag);
  response.set("Cache-Control", std::string(cache_control));
  return response;
}

void add_frame_routes(Router& router, App& app) {
  router
      .add("GET", "/v1/scenes/{id}/frame.png", Scope::read, LogLevel::info,
           [&app](Request& request) {
             RequestTrace trace;
             const RenderOrder order = make_order(app.scenes().find(request.path_value("id")),
                                                  read_query(request), FileFormat::png, caller_of(request));
             return frame_response(app, request, order, trace, "public, max-age=31536000, immutable");
           })
      .describe(
          {.id = "get_frame",
           .summary = "Renders one image, which depends only on its URL unless the URL sets a time budget",
           .parameters = {kSceneId},
           .renders = true,
           .etag = Operation::ETag::if_it_lasts,
           .answers = {{.status = 200,
                        .description = "The image",
                        .headers = {"Cache-Control", "Content-Location"},
                        .content = {{"image/png"}},
                        .has_results = true}}});
}

}  // namespace orrery
