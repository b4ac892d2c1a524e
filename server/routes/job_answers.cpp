#include "server/routes/job_answers.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/shorten.h"
#include "server/routes/problem.h"

namespace orrery {

using nlohmann::ordered_json;

std::string job_path(const std::string& job_id) { return "/v1/jobs/" + job_id; }

ordered_json with_prefix(ordered_json links, const std::string& prefix) {
  for (auto& link : links) link = prefix + link.get<std::string>();
  return links;
}

ordered_json job_json(const Job& job, const JobStatus& status, const std::string& prefix) {
  const auto milli = [](double seconds) { return std::round(seconds * 1000) / 1000; };
  ordered_json json = {{"id", job.id()},
                       {"state", name_of(status.state)},
                       {"frames", status.steps},
                       {"frames_done", status.steps_done},
                       {"tiles", status.tiles},
                       {"tiles_done", status.tiles_done},
                       {"elapsed_s", milli(status.elapsed_s)},
                       {"events", prefix + job_path(job.id()) + "/events"}};
  json.update(with_prefix(job.work().links(job.id()), prefix));
  json.update(job.work().status_fields(status.steps_done));
  if (status.remaining_s) json["remaining_s"] = milli(*status.remaining_s);
  if (status.error)
    json["error"] = ordered_json::parse(std::string_view(problem_response(status.error, job.id()).body));
  return json;
}

Response start_job(App& app, Request& request, JobSpec spec, const std::string& content,
                   const RequestTrace& trace) {
  const std::string key = request.header("Idempotency-Key").value_or("");
  constexpr std::size_t kLongestKey = 255;
  if (key.size() > kLongestKey)
    throw HttpError(400, "Idempotency-Key must have at most " + grouped(kLongestKey) + " characters (got " +
                             grouped(key.size()) + ")");
  const Jobs::StartResult started = app.jobs().start(std::move(spec), key, content);
  Response response = json_answer(202, job_json(*started.job, started.job->status(), request.prefix));
  response.set("Location", job_path(started.job->id()));
  response.set("Server-Timing", server_timing(trace.timing));
  response.set("Cache-Control", "no-store");
  return response;
}

Response job_result(App& app, const Request& request, const std::string& job_id) {
  const auto job = app.jobs().find(job_id);
  const JobResult result = job->work().result(job_id, request.path);
  const JobStatus status = job->status();
  if (status.steps_done < result.after.value_or(status.steps))
    throw HttpError(409, result.name + " is not ready: " + std::to_string(status.steps_done) + " of " +
                             std::to_string(status.steps) + " images are done, and the job is " +
                             std::string(name_of(status.state)));
  const std::string etag = "\"" + job_id + request.path.substr(request.path.rfind('/')) + "\"";
  Response response{.status = 304};
  if (!has_current(request, etag)) response = text_response(200, result.type, result.read(request.prefix));
  response.set("ETag", etag);
  response.set("Cache-Control", "private, max-age=31536000, immutable");
  return response;
}

}  // namespace orrery
