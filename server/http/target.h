#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/http/message.h"

namespace orrery {

// A parsed request target.
struct Target {
  std::vector<std::string> segments;  // decoded; "/" has none, "/a/" has "a" and ""
  std::string path;                   // decoded
  Fields query;                       // decoded; names are unique
  std::string authority;              // "host:port" of an absolute target; empty for a path
};

// Parses an absolute path, or an http or https URI (RFC 9112, 3.2.2), whose path may be empty. Throws
// HttpError 400 for other targets, malformed %-escapes, invalid UTF-8, control characters and repeated query
// parameters.
Target parse_target(std::string_view target);

// Returns "?" and the encoded fields, or "" if there are none.
std::string query_text(const Fields& query);

}  // namespace orrery
