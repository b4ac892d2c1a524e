#include <nlohmann/json.hpp>

#include "core/plan/warnings.h"
#include "server/app/app.h"
#include "server/routes/answers.h"
#include "server/routes/picture_stream.h"

// GET /v1/scenes/{id}/refinement: streams one image in passes with increasing samples. The image of each pass
// equals frame.png with the same number of samples.
namespace orrery {
namespace {

nlohmann::ordered_json header_of(const Refinement::Step& step, const Plan& plan,
                                 const ImageResults& results) {
  nlohmann::ordered_json header = {{"of", plan.samples},
                                   {"width", plan.width},
                                   {"height", plan.height},
                                   {"render_ms", step.render_ms},
                                   {"encode_ms", step.encode_ms}};
  header.update(result_members(&ResultOutputs::refinement_frame, results));
  return header;
}

// State of a refinement stream whose first image is rendered.
struct RefinementRequest {
  std::shared_ptr<const void> place;
  std::shared_ptr<Refinement> refinement;
  std::optional<Refinement::Step> first;
};

// Writes an image. Skips an image that exceeds the quota of response bytes, but throws LimitExceeded for the
// last one. Returns false if the client has disconnected.
bool write(PictureWriter& writer, const Refinement& refinement, const Refinement::Step& step) {
  ImageResults results = results_of(*step.picture);
  results.samples = step.samples;
  results.rays = step.rays;
  try {
    return writer.write({.png = {step.picture, step.picture->bytes},
                         .header = header_of(step, refinement.plan(), results),
                         .fields = result_headers(&ResultOutputs::refinement_part, results),
                         .last = refinement.at_end()});
  } catch (const LimitExceeded&) {
    if (refinement.at_end()) throw;
    return true;
  }
}

void send(const RefinementRequest& request, PictureWriter&& writer) {
  try {
    for (auto step = request.first; step; step = request.refinement->next())
      if (!write(writer, *request.refinement, *step)) return;
  } catch (const Cancelled&) {
    return;  // the client has disconnected
  }
  writer.end();
}

Response refine(App& app, Request& request) {
  app.require_open();
  const auto scene = app.scenes().find(request.path_value("id"));
  const RenderRequest wanted = read_query(request);
  require_layers_kept(wanted, FileFormat::png);
  require_no_budget(wanted, "a refinement");
  require_picture(wanted, "a refinement");
  RenderOrder order = make_order(scene, wanted, FileFormat::png, caller_of(request));
  const StreamFormat format = negotiate_stream(request);
  Response response;
  set_stream_headers(response, format);
  set_results(response, {.warnings = find_warnings(scene->scene(), order.plan)});
  if (request.method == "HEAD") return response;
  RefinementRequest refined{
      .place = app.streams().open(request.client), .refinement = app.refine(std::move(order)), .first = {}};
  refined.first = refined.refinement->next();  // errors can still set the status
  set_results(response, {.warnings = refined.first->picture->warnings});
  response.stream = [refined, format](Sink& sink) { send(refined, PictureWriter(sink, format)); };
  return response;
}

}  // namespace

void add_refinement_routes(Router& router, App& app) {
  router
      .add("GET", "/v1/scenes/{id}/refinement", Scope::read, LogLevel::info,
           [&app](Request& request) { return refine(app, request); })
      .describe(
          {.id = "refine_frame",
           .summary = "Streams one image in passes, each with about twice the samples of the previous pass. "
                      "Each pass equals frame.png with the same number of samples",
           .parameters = {kSceneId},
           .renders = true,
           .answers = {stream_answer(
               "A stream of PNG images in the format of an orbit. The header of a frame contains of (samples "
               "of the last pass), width, height, and the render_ms and encode_ms of the pass. If the last "
               "image is cached, the stream contains only that image. ",
               "RefinementResults", &ResultOutputs::refinement_part)},
           .errors = {406}});
}

}  // namespace orrery
