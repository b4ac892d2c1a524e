#include <nlohmann/json.hpp>

#include "core/load/load.h"
#include "core/params/params.h"
#include "server/api/chart_forms.h"
#include "server/rendering/picture_key.h"
#include "server/routes/job_answers.h"

// /v1/scenes/{id}/charts: jobs that chart render time against error.
namespace orrery {
namespace {

using nlohmann::ordered_json;

// Renders the images of a chart and discards them after measuring their errors.
class ChartWork final : public JobWork {
 public:
  ChartWork(const Scene& scene, const RenderRequest& view, const Study::Extent& extent)
      : study_(scene, view, extent) {}

  int steps() const override { return study_.pictures(); }
  RenderRequest request(int step) const override { return study_.request(step); }
  FileFormat format() const override { return FileFormat::exr; }  // errors of linear values
  void add(const RenderResult& rendered) override { study_.add(rendered); }
  std::string encode(const Film&) const override { return {}; }
  void keep(int, std::string&&) override {}
  void end() override { study_.end(); }

  ordered_json links(const std::string& job_id) const override {
    return {{"chart", folder() + job_id + ".svg"}};
  }
  ordered_json links_of_step(const std::string&, int) const override { return ordered_json::object(); }
  ordered_json status_fields(int) const override { return ordered_json::object(); }
  ordered_json step_fields(int) const override { return ordered_json::object(); }
  JobResult result(const std::string& job_id, std::string_view path) const override {
    const ChartForm* form = chart_form_of(path);
    if (!form || path != folder() + job_id + std::string(form->ending))
      throw NotFound("unknown file; the files of the job are " + job_id + ".svg, .csv and .json");
    return {"chart", form->type, std::nullopt,
            [this, form](const std::string& prefix) { return form->write(study_.chart(), prefix); }};
  }

 private:
  std::string folder() const { return "/v1/scenes/" + study_.scene_id() + "/charts/"; }

  Study study_;
};

struct ChartOrder {
  RenderRequest view;
  Study::Extent extent;
};

ChartOrder read_chart_order(App& app, Request& request, RequestTrace& trace) {
  if (request.body.empty()) request.body = Body("{}");
  ChartOrder order;
  order.extent.threads = app.settings().threads;
  app.read(request.body, caller_of(request), trace, [&](const Document& document, const AssetSource&) {
    for (const char* key : {"scene", "scene_id"})
      if (document.member(key))
        throw InputError(std::string("/") + key, "cannot be used here (the URL names the scene)");
    order.view = read_request(document, [&](Params& p) {
      p.optional_object("chart", "Extent of the chart.", [&](Params& c) { read_extent(c, order.extent); });
    });
  });
  return order;
}

// Returns a canonical text of all inputs of a chart, including options that change only the time.
std::string canonical_chart(const Scene& scene, const ChartOrder& order) {
  return "chart " + scene.id + " " + canonical_work(scene, order.view) + " " +
         std::to_string(order.extent.samples) + " " + std::to_string(order.extent.rounds) + " " +
         std::to_string(order.extent.width);
}

Response start_chart(App& app, Request& request) {
  app.require_open();
  const auto prepared = app.scenes().find(request.path_value("id"));
  RequestTrace trace;
  const ChartOrder order = read_chart_order(app, request, trace);
  const Scene& scene = prepared->scene();
  JobSpec spec{prepared, std::make_unique<ChartWork>(scene, order.view, order.extent), request.client};
  return start_job(app, request, std::move(spec), canonical_chart(scene, order), trace);
}

Response get_chart(App& app, Request& request) {
  const std::string name = request.path_value("chart");
  const ChartForm* form = chart_form_of(name);
  if (!form) throw HttpError(404, "chart name must end in .svg, .csv or .json (got " + quoted(name) + ")");
  return job_result(app, request, name.substr(0, name.size() - form->ending.size()));
}

}  // namespace

void add_charts_routes(Router& router, App& app) {
  router
      .add("POST", "/v1/scenes/{id}/charts", Scope::render, LogLevel::info, json_body(app),
           [&app](Request& request) { return start_chart(app, request); })
      .describe({.id = "start_chart",
                 .summary = "Starts a job that charts the speed against the accuracy of an image",
                 .parameters = {kSceneId, kIdempotencyKey},
                 .body = {"application/json", "ChartRequest"},
                 .body_required = false,
                 .answers = {kJobAccepted}});
  router
      .add("GET", "/v1/scenes/{id}/charts/{chart}", Scope::read, LogLevel::info,
           [&app](Request& request) { return get_chart(app, request); })
      .describe(
          {.id = "get_chart",
           .summary = "Returns the chart of a job",
           .parameters = {kSceneId, {"chart", "path", "Id of the job, followed by .json, .svg or .csv"}},
           .etag = Operation::ETag::always,
           .answers = {{200,
                        "The chart. A null in JSON is an empty field in CSV",
                        {},
                        {{"application/json", "Chart"}, {"image/svg+xml"}, {"text/csv"}}}},
           .errors = {409}});
}

}  // namespace orrery
