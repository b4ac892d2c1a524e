#pragma once

#include <exception>
#include <string_view>

#include "server/http/message.h"

namespace orrery {

// Returns the response for any exception: problem details (RFC 9457) with the request ID. Unexpected
// exceptions become a 500 without details; their text is in Response::note.
Response problem_response(std::exception_ptr error, std::string_view request_id);

}  // namespace orrery
