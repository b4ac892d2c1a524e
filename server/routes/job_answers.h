#pragma once

#include "server/routes/answers.h"

// What routes that start and follow jobs share.
namespace orrery {

std::string job_path(const std::string& job_id);
// Links of JobWork as clients need them.
nlohmann::ordered_json with_prefix(nlohmann::ordered_json links, const std::string& prefix);
// How far it is, and where its results are: links begin with `prefix`.
nlohmann::ordered_json job_json(const Job& job, const JobStatus& status, const std::string& prefix);

// Starts it, once for an Idempotency-Key with the same `content`: 202. Throws HttpError, and what
// Jobs::start() does.
Response start_job(App& app, Request& request, JobSpec spec, const std::string& content,
                   const Timing& timing);

// The file of the job that has the request's path; 304 for who knows it, and then it is not written. Throws
// NotFound, and HttpError 409 for a file that is not made yet, or will not be.
Response job_result(App& app, const Request& request, const std::string& job_id);

}  // namespace orrery
