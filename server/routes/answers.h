#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/plan/request.h"
#include "server/app/app.h"
#include "server/routes/router.h"

// What several routes need to read a request and to write an answer.
namespace orrery {

Caller caller_of(const Request& request);

// A body of JSON, of at most `body_bytes`. Refuses other content types, what is compressed, and a query.
RouteBody json_body(const App& app);
// Throws HttpError 415 for a body that is compressed.
void refuse_compressed(const Request& request);

// The options of a render in the query. `more` names what else the query may have; its values are left alone.
// Throws InputError, with pointers such as "/azimuth".
RenderRequest read_query(const Request& request, std::span<const std::string_view> more = {});
// What a client wrote, or the start of it, as errors show it.
std::string quoted(const std::string& text);

// Whether the client has what the ETag stands for.
bool has_current(const Request& request, std::string_view etag);

// The type of `offered` that the Accept header likes best; the first of equals. Throws HttpError 406.
std::string_view negotiate(const Request& request, std::span<const std::string_view> offered);

// "load;dur=1.25, render;dur=40.1": the steps that took any time.
std::string server_timing(const Timing& timing);

// Sets Orrery-Warning, unless there are none.
void set_warnings(Response& response, std::span<const Problem> warnings);

// A picture, and what it took: Server-Timing with the steps, the structure and its counted work, and X-Rays;
// X-RMSE where its samples tell their error.
Response picture_response(std::string_view type, const Rendered& rendered, const Timing& timing);

// Of a picture that was made to a budget: Orrery-Budget, what became of it; and of PNG Content-Location, the
// address that gives the same bytes without it, below `prefix`.
void set_budget(Response& response, std::string_view type, const Scene& scene, const Picture& picture,
                const std::string& prefix);

Response json_answer(int status, const nlohmann::ordered_json& json);

}  // namespace orrery
