#pragma once

#include <string>
#include <vector>

#include "server/http/message.h"

namespace orrery {

// Cross-origin requests (the Fetch standard's CORS protocol) from origins that are listed; "*" lists all.

// The answer to a preflight request; none if this is none, or its origin is not listed.
std::optional<Response> preflight(const Request& request, const std::vector<std::string>& origins);

// Refuses what a page of another origin, not listed, asks a browser to change: browsers send some such
// requests without asking first. `domains`: whether a domain may be our own origin. Without access control it
// may not, as its owner can let it stand for this machine (DNS rebinding). Throws HttpError 403.
void refuse_foreign(const Request& request, const std::vector<std::string>& origins, bool domains);

// Refuses what is asked of a domain with a dot that no listed origin has: its owner may have let it stand for
// this machine, so that his pages read what is here. Throws HttpError 403.
void refuse_foreign_host(const Request& request, const std::vector<std::string>& origins);

// Lets pages of a listed origin read the answer.
void allow_origin(const Request& request, const std::vector<std::string>& origins, Response& response);

}  // namespace orrery
