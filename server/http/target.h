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
};

// Throws HttpError 400 for what is no path from the root, a broken %-escape, text that is not UTF-8 or has
// control characters, or a name that the query has twice.
Target parse_target(std::string_view target);

}  // namespace orrery
