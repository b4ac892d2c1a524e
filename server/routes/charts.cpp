#include <nlohmann/json.hpp>

#include "core/load/load.h"
#include "core/params/params.h"
#include "core/plan/plan.h"
#include "server/app/chart_forms.h"
#include "server/app/picture_key.h"
#include "server/routes/job_answers.h"

// /v1/scenes/{id}/charts: speed against accuracy of a picture, measured by a job.
namespace orrery {
namespace {

struct ChartOrder {
  RenderRequest view;
  Study::Extent extent;
};

ChartOrder read_render_order(App& app, Request& request, Timing& timing) {
  const std::string body = std::move(request.body);
  ChartOrder order;
  app.read(body.size(), caller_of(request), timing, [&](const MeshSource&) {
    const Document document = parse_document(body.empty() ? "{}" : body);
    for (const char* key : {"scene", "scene_id"})
      if (document.member(key)) throw InputError(std::string("/") + key, "the address names the scene");
    order.view = read_request(document, [&](Params& p) {
      p.optional_object("chart", "What is tried.", [&](Params& c) { read_extent(c, order.extent); });
    });
  });
  return order;
}

// All that a chart depends on: also what changes no picture, but its time.
std::string canonical_chart(const Scene& scene, const ChartOrder& order) {
  return "chart " + scene.id + " " + canonical_work(scene, order.view) + " " +
         std::to_string(order.extent.samples) + " " + std::to_string(order.extent.rounds);
}

Response start_chart(App& app, Request& request) {
  app.require_open();
  JobSpec spec;
  spec.scene = app.scenes().find(request.path_value("id"));
  spec.client = request.client;
  Timing timing;
  const ChartOrder order = read_render_order(app, request, timing);
  const Scene& scene = spec.scene->scene();
  spec.study = std::make_shared<Study>(scene, order.view, order.extent);
  spec.frames = spec.study->pictures();
  return start_job(app, request, std::move(spec), canonical_chart(scene, order), timing);
}

Response get_chart(App& app, Request& request) {
  const std::string name = request.path_value("chart");
  const ChartForm* form = chart_form_of(name);
  if (!form) throw HttpError(404, "A chart can be had as .svg, .csv and .json");
  const auto job = app.jobs().find(name.substr(0, name.size() - form->ending.size()));
  const auto study = job->study();
  if (!study || study->scene_id() != request.path_value("id"))
    throw HttpError(404, "The job makes no chart of this scene");
  const JobStatus status = job->status();
  if (status.state != JobState::done) refuse_result("The chart", status);
  return result_response(request, "\"" + name + "\"", form->type,
                         [&] { return form->write(study->chart()); });
}

}  // namespace

void add_charts_routes(Router& router, App& app) {
  router.add("POST", "/v1/scenes/{id}/charts", Scope::render, LogLevel::info, json_body(app),
             [&app](Request& request) { return start_chart(app, request); });
  router.add("GET", "/v1/scenes/{id}/charts/{chart}", Scope::read, LogLevel::info,
             [&app](Request& request) { return get_chart(app, request); });
}

}  // namespace orrery
