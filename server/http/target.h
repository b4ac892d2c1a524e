#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/http/message.h"

namespace orrery {

// The target of a request, taken apart.
struct Target {
  std::vector<std::string> segments;  // of the path, decoded; "/" has none, "/a/" has "a" and ""
  std::string path;                   // decoded
  Fields query;                       // decoded; names are unique
  std::string authority;              // "host:port" of an absolute target; empty if it is a path
};

// Takes a path from the root, or an absolute address of http or https (RFC 9112, 3.2.2), whose path may be
// empty. Throws HttpError 400 for anything else, a broken %-escape, text that is not UTF-8 or has control
// characters, or a name that the query has twice.
Target parse_target(std::string_view target);

// "?" and the fields, encoded; none: "".
std::string query_text(const Fields& query);

}  // namespace orrery
