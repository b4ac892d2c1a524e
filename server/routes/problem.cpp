#include "server/routes/problem.h"

#include <cmath>
#include <new>
#include <nlohmann/json.hpp>

#include "core/base/shorten.h"
#include "server/api/error_report.h"
#include "server/scheduler/admission.h"
#include "server/scheduler/watch.h"

namespace orrery {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMaxBytes = 64 * 1024;   // response body
constexpr std::size_t kMostCharacters = 4500;  // detail; each has at most 6 bytes in JSON

// Returns the response body. Leaves out its last errors if it would exceed kMaxBytes. REQUIRES: one error
// fits.
std::string text_of(ordered_json problem) {
  const auto text = [&] {
    return problem.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
  };
  std::string body = text();
  if (!problem.contains("errors")) return body;
  for (ordered_json& errors = problem["errors"]; body.size() > kMaxBytes && errors.size() > 1; body = text())
    errors.erase(errors.size() - 1);
  return body;
}

Response respond(int status, std::string_view title, std::string_view detail, std::string_view request_id,
                 std::string_view type = "about:blank", const ordered_json& more = ordered_json::object()) {
  ordered_json problem = {{"type", type},
                          {"title", title},
                          {"status", status},
                          {"detail", shortened(detail, kMostCharacters)},
                          {"request_id", request_id}};
  problem.update(more);
  Response response = text_response(status, "application/problem+json", text_of(std::move(problem)));
  response.set("Cache-Control", "no-store");
  return response;
}

Response respond(int status, std::string_view detail, std::string_view request_id) {
  return respond(status, reason_phrase(status), detail, request_id);
}

ordered_json list_of(const std::vector<Problem>& problems) {
  ordered_json errors = ordered_json::array();
  for (const Problem& p : problems) errors.push_back({{"pointer", p.pointer}, {"detail", p.detail}});
  return {{"errors", std::move(errors)}};
}

Response try_later(int status, const Busy& error, std::string_view request_id, const char* refusal) {
  Response response = respond(status, error.what(), request_id);
  // Spreads Retry-After, so that clients that were rejected together do not all retry together.
  const auto seconds = static_cast<std::size_t>(std::ceil(error.retry_after_s()));
  const std::size_t spread = std::hash<std::string_view>()(request_id) % (1 + seconds / 4);
  response.set("Retry-After", std::to_string(seconds + spread));
  response.refusal = refusal;
  return response;
}

Response malformed(const MalformedJson& error, std::string_view request_id) {
  ordered_json more = list_of(error.problems());
  more["offset"] = error.offset();
  more["line"] = error.line();
  more["column"] = error.column();
  return respond(400, "Request body is not JSON", error.what(), request_id,
                 "urn:orrery:problem:malformed-json", more);
}

// Returns a 422 with the outcome of the budget and the certificate.
Response missed(const BudgetMissed& error, std::string_view request_id) {
  const BudgetOutcome& outcome = error.outcome();
  ordered_json more =
      list_of({{outcome.error_met ? "/budget/time_limit_seconds" : "/budget/max_error", outcome.reason}});
  more["budget"] = budget_json(outcome);
  more["certificate"] = certificate_json(error.certificate());
  return respond(422, "Budget cannot be met", error.what(), request_id, "urn:orrery:problem:missed-budget",
                 more);
}

Response invalid(const InputError& error, std::string_view request_id) {
  return respond(422, "Invalid input", error.what(), request_id, "urn:orrery:problem:invalid-input",
                 list_of(error.problems()));
}

}  // namespace

Response problem_response(std::exception_ptr error, std::string_view request_id) {
  try {
    std::rethrow_exception(error);
  } catch (const HttpError& e) {
    Response response = respond(e.status(), e.what(), request_id);
    for (const auto& [name, value] : e.headers()) response.set(name, value);
    response.refusal = e.limit();
    return response;
  } catch (const MalformedJson& e) {
    return malformed(e, request_id);
  } catch (const TooManyRays& e) {
    Response response = invalid(e, request_id);
    response.refusal = e.limit();
    return response;
  } catch (const InputError& e) {
    return invalid(e, request_id);
  } catch (const BudgetMissed& e) {
    return missed(e, request_id);
  } catch (const NotFound& e) {
    return respond(404, e.what(), request_id);
  } catch (const Forbidden& e) {
    return respond(403, e.what(), request_id);
  } catch (const ClientLimitExceeded& e) {
    return try_later(429, e, request_id, e.limit());
  } catch (const LimitExceeded& e) {
    return try_later(503, e, request_id, e.limit());
  } catch (const Busy& e) {
    return try_later(503, e, request_id, "draining");
  } catch (const TimedOut& e) {
    Response response = respond(504, e.what(), request_id);
    response.refusal = "request_seconds";
    return response;
  } catch (const Cancelled& e) {
    return respond(499, e.what(), request_id);
  } catch (const std::bad_alloc&) {
    return try_later(503, Busy("not enough memory; retry later", 5), request_id, "memory_bytes");
  } catch (const std::exception& e) {
    Response response = respond(500, "internal error; the log has details under this request id", request_id);
    response.note = e.what();
    return response;
  } catch (...) {
    return respond(500, "internal error", request_id);
  }
}

}  // namespace orrery
