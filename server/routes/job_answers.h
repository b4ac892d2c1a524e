#pragma once

#include "server/routes/answers.h"

// Helpers of the routes that start jobs and report their progress.
namespace orrery {

// Placeholder of a path below /v1/jobs/.
inline constexpr Operation::Parameter kJobId{"id", "path", "Id of a job"};
// Header of a request that starts a job.
inline constexpr Operation::Parameter kIdempotencyKey{
    "Idempotency-Key", "header", "Requests of a client with the same key start only one job",
    R"({"type": "string", "maxLength": 255})"};
// Response to a request that starts a job.
inline const Operation::Answer kJobAccepted{
    202, "The job is accepted", {"Location"}, {{"application/json", "Job"}}};

std::string job_path(const std::string& job_id);
// Returns the links of JobWork, each with `prefix` prepended.
nlohmann::ordered_json with_prefix(nlohmann::ordered_json links, const std::string& prefix);
// Returns the progress of the job and its links below `prefix`.
nlohmann::ordered_json job_json(const Job& job, const JobStatus& status, const std::string& prefix);

// Starts a job and returns 202. A repeated Idempotency-Key with the same `content` returns the existing job.
// Throws HttpError 400 if the key is too long, and the errors of Jobs::start().
Response start_job(App& app, Request& request, JobSpec spec, const std::string& content,
                   const RequestTrace& trace);

// Returns the result file at the request's path, or 304 without creating the file if the client has it.
// Throws NotFound if no such file exists, and HttpError 409 if it is not finished.
Response job_result(App& app, const Request& request, const std::string& job_id);

}  // namespace orrery
