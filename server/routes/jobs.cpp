#include <array>
#include <nlohmann/json.hpp>

#include "core/base/number.h"
#include "core/params/params.h"
#include "core/plan/plan.h"
#include "server/app/picture_key.h"
#include "server/routes/job_answers.h"
#include "server/routes/render_order.h"

// /v1/jobs: pictures and orbits that take longer than anybody holds a connection open for.
namespace orrery {
namespace {

using nlohmann::ordered_json;

JobSpec read_job(App& app, Request& request, Timing& timing) {
  JobSpec spec;
  spec.client = request.client;
  double step_degrees = 0;
  std::optional<double> time_step_s;
  bool orbits = false;
  const RenderOrder order = read_render_order(app, request, timing, [&](Params& p) {
    orbits = p.has("orbit");
    p.optional_object("orbit", "A turn of the camera; missing: one picture.", [&](Params& o) {
      const std::int64_t most = app.settings().orbit_frames;
      spec.frames = static_cast<int>(
          o.integer("frames", "Pictures of it.", 1, most, std::min<std::int64_t>(most, orbits ? 120 : 1)));
      step_degrees = o.number("step_degrees", "Turn from picture to picture.", {.min = -360, .max = 360},
                              derived(360.0 / spec.frames));
      const double time = o.number("time_step_s", "Motion from picture to picture.",
                                   {.min = -kLongestStep_s, .max = kLongestStep_s}, derived(0.0));
      if (o.has("time_step_s")) time_step_s = time;
    });
  });
  require_layers_kept(order.request, FileFormat::png);
  const Scene& scene = order.scene->scene();
  spec.scene = order.scene;
  spec.path = full_turn(scene, order.request, spec.frames);
  spec.path.step_degrees = step_degrees;
  if (!orbits) spec.path.step_seconds = 0;
  if (time_step_s) spec.path.step_seconds = *time_step_s;
  require_range(spec.path, spec.frames, "/orbit/step_degrees");
  return spec;
}

Response start_orbit(App& app, Request& request) {
  app.require_open();
  Timing timing;
  JobSpec spec = read_job(app, request, timing);
  const std::string content = canonical_orbit(spec.scene->scene(), spec.path, spec.frames);
  return start_job(app, request, std::move(spec), content, timing);
}

Response get_job(App& app, Request& request) {
  const auto job = app.jobs().find(request.path_value("id"));
  Response response = json_answer(200, job_json(*job, job->status()));
  response.set("Cache-Control", "no-store");
  return response;
}

// "12.png": 12. Throws HttpError 404 for what is no frame of the job.
int frame_of(const Job& job, const std::string& name) {
  if (job.study()) throw HttpError(404, "The job makes a chart and keeps no pictures");
  const auto number = number_in<int>(std::string_view(name).substr(0, name.find('.')));
  if (number && name == std::to_string(*number) + ".png" && *number >= 0 && *number < job.frames())
    return *number;
  throw HttpError(404, "The job has frames 0.png to " + std::to_string(job.frames() - 1) + ".png");
}

Response get_frame(App& app, Request& request) {
  const auto job = app.jobs().find(request.path_value("id"));
  const int number = frame_of(*job, request.path_value("frame"));
  const auto picture = job->frame(number);
  if (!picture) refuse_result("Frame " + std::to_string(number), job->status());
  return result_response(request, "\"" + job->id() + "-" + std::to_string(number) + "\"", "image/png",
                         [&] { return *picture; });
}

std::string event(std::string_view name, int id, const ordered_json& data) {
  return "event: " + std::string(name) + "\nid: " + std::to_string(id) + "\ndata: " + data.dump() + "\n\n";
}

// Events are numbered by the frames that are done when they are sent, the last one by one more: who comes
// back with the number it saw last misses no frame.
struct Events {
  std::shared_ptr<Job> job;
  int seen;                 // frames that the client knows of
  std::int64_t tiles = -1;  // likewise
  bool ended = false;

  void send(Sink& sink, const Timer& timer, const std::stop_token& gone) {
    constexpr std::chrono::milliseconds kLeast{100};  // between two reports of progress
    constexpr std::chrono::seconds kSilence{10};      // after which the client is told that the line is open
    std::string text = news(job->status());
    while (sink.write(text) && !ended && !gone.stop_requested()) {
      const auto spoke = timer.now();
      JobStatus status = job->wait(seen, std::nullopt, spoke + kLeast, gone);
      if (status.frames_done == seen && !has_ended(status.state))
        status = job->wait(seen, tiles, spoke + kSilence, gone);
      text = news(status);
    }
  }

 private:
  // What the client does not know yet.
  std::string news(const JobStatus& status) {
    const bool moved = std::exchange(tiles, status.tiles_done) != status.tiles_done;
    ended = has_ended(status.state);
    std::string text;
    for (; seen < status.frames_done; ++seen) text += frame_event(status);
    if (ended) return text + event(name_of(status.state), status.frames + 1, job_json(*job, status));
    if (!text.empty()) return text;
    return moved ? event("progress", seen, job_json(*job, status)) : ": still waiting\n\n";
  }
  std::string frame_event(const JobStatus& status) const {
    ordered_json json = job_json(*job, status);
    json["frame"] = seen;
    if (!job->study()) json["href"] = job_path(*job) + "/frames/" + std::to_string(seen) + ".png";
    return event("frame", seen + 1, json);
  }
};

Response get_events(App& app, Request& request) {
  const auto job = app.jobs().find(request.path_value("id"));
  constexpr std::array<std::string_view, 1> kType{"text/event-stream"};
  negotiate(request, kType);
  int seen = 0;
  if (const auto last = request.header("Last-Event-ID")) {
    seen = number_in<int>(*last).value_or(-1);
    if (seen < 0) throw HttpError(400, "Last-Event-ID is no number of an event: " + last->substr(0, 40));
  }
  if (seen > job->frames()) return {.status = 204};  // it has seen the end: no need to come again
  Response response;
  response.set("Content-Type", "text/event-stream");
  response.set("Cache-Control", "no-store").set("X-Accel-Buffering", "no");
  if (request.method == "HEAD") return response;
  response.stream = [place = app.streams().open(request.client), events = Events{job, seen},
                     gone = request.gone,
                     &timer = app.timer()](Sink& sink) mutable { events.send(sink, timer, gone); };
  return response;
}

Response remove_job(App& app, Request& request) {
  app.jobs().remove(request.path_value("id"));
  return {.status = 204};
}

}  // namespace

void add_jobs_routes(Router& router, App& app) {
  router.add("POST", "/v1/jobs", Scope::render, LogLevel::info, json_body(app),
             [&app](Request& request) { return start_orbit(app, request); });
  router.add("GET", "/v1/jobs/{id}", Scope::read, LogLevel::info,
             [&app](Request& request) { return get_job(app, request); });
  router.add("DELETE", "/v1/jobs/{id}", Scope::render, LogLevel::info,
             [&app](Request& request) { return remove_job(app, request); });
  router.add("GET", "/v1/jobs/{id}/events", Scope::read, LogLevel::info,
             [&app](Request& request) { return get_events(app, request); });
  router.add("GET", "/v1/jobs/{id}/frames/{frame}", Scope::read, LogLevel::info,
             [&app](Request& request) { return get_frame(app, request); });
}

}  // namespace orrery
