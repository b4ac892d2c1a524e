#pragma once

#include <functional>

#include "server/routes/answers.h"

// What routes that start and follow jobs share.
namespace orrery {

std::string job_path(const Job& job);
// How far it is, and where its results are.
nlohmann::ordered_json job_json(const Job& job, const JobStatus& status);

// Starts it, once for an Idempotency-Key with the same `content`: 202. Throws HttpError, and what
// Jobs::start() does.
Response start_job(App& app, Request& request, JobSpec spec, const std::string& content,
                   const Timing& timing);

// Throws HttpError 409: `what` is not made yet, or will not be.
[[noreturn]] void refuse_result(const std::string& what, const JobStatus& status);

// What a job has made, which never changes; 304 for who knows it, and then `write` is not called.
Response result_response(const Request& request, const std::string& etag, std::string_view type,
                         const std::function<std::string()>& write);

}  // namespace orrery
