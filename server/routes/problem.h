#pragma once

#include <exception>
#include <string_view>

#include "server/http/message.h"

namespace orrery {

// The one place where what was thrown becomes an answer: problem details (RFC 9457) with the request's id. An
// exception that nobody planned gives a 500 whose text tells nothing; what it said is in Response::note.
Response problem_response(std::exception_ptr error, std::string_view request_id);

}  // namespace orrery
