#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/plan/request.h"
#include "server/api/results.h"
#include "server/app/app.h"
#include "server/routes/router.h"

// Helpers of the routes for reading requests and writing responses.
namespace orrery {

// Placeholder of a path below /v1/scenes/.
inline constexpr Operation::Parameter kSceneId{"id", "path",
                                               "Id of a scene: the SHA-256 of its canonical JSON"};

Caller caller_of(const Request& request);

// Returns the RouteBody for JSON of at most `max_request_body_bytes`. It rejects other content types,
// compressed bodies and query parameters.
RouteBody json_body(const App& app);
// Throws HttpError 415 if the body is compressed.
void refuse_compressed(const Request& request);

// Returns the render options of the query. `more`: other query parameters, which are allowed but not read.
// Throws InputError with pointers such as "/azimuth".
RenderRequest read_query(const Request& request, std::span<const std::string_view> more = {});
// Returns up to 40 bytes of a client's text in quotes, for error messages.
std::string quoted(const std::string& text);

// Returns whether If-None-Match lists `etag` (weak comparison) or "*".
bool has_current(const Request& request, std::string_view etag);

// Returns the first type of `offered` with the highest weight in the Accept header. Throws HttpError 406 if
// no type is acceptable.
std::string_view negotiate(const Request& request, std::span<const std::string_view> offered);

// Returns the nonzero steps in ms as a Server-Timing value: "load;dur=1.25, render;dur=40.1".
std::string server_timing(const Timing& timing);

// Returns statistics, certificate, budget and warnings of the image, which must outlive the returned object.
ImageResults results_of(const Picture& picture);
// Sets the headers of the results that are known.
void set_results(Response& response, const ImageResults& results);

// Returns a response with the image, Server-Timing and the headers of its results. If the image was rendered
// for this request, Server-Timing includes the accelerator and its counted work, and the rays are a result.
Response picture_response(std::string_view type, const Rendered& rendered, const RequestTrace& trace);

// Sets Content-Location if the image is a PNG with a budget: a URL below `prefix` that returns the same bytes
// without a budget.
void set_content_location(Response& response, std::string_view type, const Scene& scene,
                          const Picture& picture, const std::string& prefix);

Response json_answer(int status, const nlohmann::ordered_json& json);

}  // namespace orrery
