#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/plan/request.h"
#include "server/app/app.h"
#include "server/routes/router.h"

// Helpers of the routes that read requests and write responses.
namespace orrery {

Caller caller_of(const Request& request);

// JSON body of at most `body_bytes`. Rejects other content types, compressed bodies and query parameters.
RouteBody json_body(const App& app);
// Throws HttpError 415 if the body is compressed.
void refuse_compressed(const Request& request);

// Returns the render options of the query. `more`: other query parameters that are allowed and not read here.
// Throws InputError with pointers such as "/azimuth".
RenderRequest read_query(const Request& request, std::span<const std::string_view> more = {});
// Returns up to 40 bytes of a client's text in quotes, for error messages.
std::string quoted(const std::string& text);

// Whether If-None-Match lists `etag` (weak comparison) or "*".
bool has_current(const Request& request, std::string_view etag);

// Returns the type of `offered` with the highest weight in the Accept header, the first of several. Throws
// HttpError 406.
std::string_view negotiate(const Request& request, std::span<const std::string_view> offered);

// Returns "load;dur=1.25, render;dur=40.1": the nonzero steps in ms.
std::string server_timing(const Timing& timing);

// Sets Orrery-Warning if there are warnings.
void set_warnings(Response& response, std::span<const Problem> warnings);

// Adds Orrery-NAME, and X-NAME for clients of version 0.1.
void add_with_former_name(Fields& fields, const std::string& name, const std::string& value);

// Adds the error bound of a picture, its RMSE if it was estimated from the samples, and its bias if it has
// one.
void add_accuracy(Fields& fields, const Picture& picture);

// Returns a response with the picture and its cost: Server-Timing with the steps, the accelerator and its
// counted work, and Orrery-Rays. Sets Orrery-RMSE if the error was estimated from the samples.
Response picture_response(std::string_view type, const Rendered& rendered, const Timing& timing);

// Sets the headers of a picture with a budget: Orrery-Budget with the outcome and, for PNG, Content-Location.
// The latter is a URL below `prefix` that gives the same bytes without a budget.
void set_budget(Response& response, std::string_view type, const Scene& scene, const Picture& picture,
                const std::string& prefix);

Response json_answer(int status, const nlohmann::ordered_json& json);

}  // namespace orrery
