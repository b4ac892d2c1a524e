#pragma once

#include "server/routes/answers.h"

// Helpers of the routes that start and follow jobs.
namespace orrery {

std::string job_path(const std::string& job_id);
// Returns the links of JobWork below `prefix`.
nlohmann::ordered_json with_prefix(nlohmann::ordered_json links, const std::string& prefix);
// Returns the progress of the job and its links below `prefix`.
nlohmann::ordered_json job_json(const Job& job, const JobStatus& status, const std::string& prefix);

// Starts a job and returns 202. A repeated Idempotency-Key with the same `content` returns the existing job.
// Throws HttpError and the errors of Jobs::start().
Response start_job(App& app, Request& request, JobSpec spec, const std::string& content,
                   const Timing& timing);

// Returns the result file at the request's path, or 304 without creating the file if the client has it.
// Throws NotFound, and HttpError 409 if the file is not finished.
Response job_result(App& app, const Request& request, const std::string& job_id);

}  // namespace orrery
