#include <array>
#include <nlohmann/json.hpp>

#include "core/base/number.h"
#include "server/routes/access.h"
#include "server/routes/job_answers.h"
#include "server/scheduler/handler_slots.h"

// /v1/jobs/{id}: progress and removal of jobs of all kinds.
namespace orrery {
namespace {

using nlohmann::ordered_json;

Response get_job(App& app, Request& request) {
  const auto job = app.jobs().find(request.path_value("id"));
  Response response = json_answer(200, job_json(*job, job->status(), request.prefix));
  response.set("Cache-Control", "no-store");
  return response;
}

std::string event(std::string_view name, int id, const ordered_json& data) {
  return "event: " + std::string(name) + "\nid: " + std::to_string(id) + "\ndata: " + data.dump() + "\n\n";
}

// Server-sent events of a job. The ID of an event is the number of finished steps reported up to and
// including it. The ID of the last event is one more than the number of all steps. A client that reconnects
// with Last-Event-ID misses no finished step.
struct Events {
  std::shared_ptr<Job> job;
  std::string prefix;       // prefix of links
  int seen;                 // finished steps reported to the client
  std::int64_t tiles = -1;  // finished tiles reported to the client
  bool ended = false;

  void send(Sink& sink, const Timer& timer, const std::stop_token& gone) {
    constexpr std::chrono::milliseconds kLeast{100};  // minimum time between two progress events
    constexpr std::chrono::seconds kSilence{10};      // maximum time without an event or a keep-alive comment
    for (JobStatus status = job->status(); tell(sink, status) && !ended && !gone.stop_requested();) {
      const HandlerSlots::Wait wait(WaitState::Kind::begun);
      const auto spoke = timer.now();
      status = job->wait(seen, std::nullopt, spoke + kLeast, gone);
      if (status.steps_done == seen && !has_ended(status.state))
        status = job->wait(seen, tiles, spoke + kSilence, gone);
    }
  }

 private:
  // Sends the events that the client has not received, or a comment if there are none. Returns false if the
  // client has disconnected.
  bool tell(Sink& sink, const JobStatus& status) {
    const bool moved = std::exchange(tiles, status.tiles_done) != status.tiles_done,
               late = seen < status.steps_done;
    ended = has_ended(status.state);
    if (!late && !ended && !moved) return sink.write(": still waiting\n\n");
    const ordered_json json = job_json(*job, status, prefix);
    for (; seen < status.steps_done; ++seen)
      if (!sink.write(frame_event(json))) return false;
    if (ended) return sink.write(event(name_of(status.state), status.steps + 1, json));
    return late || sink.write(event("progress", seen, json));
  }
  std::string frame_event(ordered_json json) const {
    json["frame"] = seen;
    json.update(with_prefix(job->work().links_of_step(job->id(), seen), prefix));
    json.update(job->work().step_fields(seen));
    return event("frame", seen + 1, json);
  }
};

Response get_events(App& app, Request& request) {
  const auto job = app.jobs().find(request.path_value("id"));
  constexpr std::array<std::string_view, 1> kType{"text/event-stream"};
  negotiate(request, kType);
  int seen = 0;
  if (const auto last = request.header("Last-Event-ID")) {
    seen = parse_number<int>(*last).value_or(-1);
    if (seen < 0)
      throw HttpError(400, "Last-Event-ID must be the ID of an event, an integer of at least 0 (got " +
                               last->substr(0, 40) + ")");
  }
  if (seen > job->status().steps) return {.status = 204};  // stops an EventSource from reconnecting
  Response response;
  response.set("Content-Type", "text/event-stream");
  response.set("Cache-Control", "no-store").set("X-Accel-Buffering", "no");
  if (request.method == "HEAD") return response;
  response.stream = [place = app.streams().open(request.client), events = Events{job, request.prefix, seen},
                     gone = request.gone,
                     &timer = app.timer()](Sink& sink) mutable { events.send(sink, timer, gone); };
  return response;
}

Response remove_job(App& app, Request& request) {
  const std::string& id = request.path_value("id");
  if (app.jobs().find(id)->client() != request.client && !may_remove_others(app.access(), request))
    throw HttpError(403,
                    "job can be removed only by the client that started it or with a token of scope admin");
  app.jobs().remove(id);
  return {.status = 204};
}

}  // namespace

void add_jobs_routes(Router& router, App& app) {
  router
      .add("GET", "/v1/jobs/{id}", Scope::read, LogLevel::info,
           [&app](Request& request) { return get_job(app, request); })
      .describe({.id = "get_job",
                 .summary = "Returns the progress of a job",
                 .parameters = {kJobId},
                 .answers = {{200, "State of the job", {}, {{"application/json", "Job"}}}}});
  router
      .add("DELETE", "/v1/jobs/{id}", Scope::render, LogLevel::info,
           [&app](Request& request) { return remove_job(app, request); })
      .describe({.id = "cancel_job",
                 .summary = "Cancels and removes a job",
                 .parameters = {kJobId},
                 .answers = {{204, "The job is removed"}}});
  router
      .add("GET", "/v1/jobs/{id}/events", Scope::read, LogLevel::info,
           [&app](Request& request) { return get_events(app, request); })
      .describe(
          {.id = "watch_job",
           .summary =
               "Streams server-sent events: progress, frame, and finally done, failed or cancelled. The "
               "data of an event is the job. A frame event adds the number and URL of the frame, and "
               "the results of components.schemas.JobFrameResults",
           .parameters = {kJobId, {"Last-Event-ID", "header", "", R"({"type": "integer", "minimum": 0})"}},
           .answers = {{200, "Events until the job ends", {}, {{"text/event-stream"}}},
                       {204, "Last-Event-ID was the last event"}},
           .errors = {400, 406, 429, 503}});
}

}  // namespace orrery
