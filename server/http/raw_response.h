#pragma once

#include <string>

#include "server/http/message.h"

namespace orrery {

// Returns the bytes of a response after which the connection closes. For clients whose request cpp-httplib
// cannot or must not read: malformed heads and rejected connections.
std::string raw_response(const Response& response);

// Returns `value` with blanks in place of control characters, so that it cannot start another header.
std::string header_value(std::string_view value);

// Whether a response with this status may have a body (RFC 9110, 6.4.1).
bool may_have_body(int status);

}  // namespace orrery
