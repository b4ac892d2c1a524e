#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/http/message.h"

namespace orrery {

// Cross-origin requests (CORS protocol of the Fetch standard) from listed origins. "*" lists all origins.

// Returns the response to a preflight request. Returns nullopt for other requests and for unlisted origins.
std::optional<Response> preflight(const Request& request, const std::vector<std::string>& origins);

// Rejects requests from pages of other, unlisted origins, except with the methods GET, HEAD and OPTIONS.
// Browsers send simple requests without a preflight. `domains`: whether the service's own origin may be a
// domain. Must be false without access control, since the owner of a domain can point it at this machine (DNS
// rebinding). Throws HttpError 403.
void reject_cross_origin(const Request& request, const std::vector<std::string>& origins, bool domains);

// Rejects requests for a host that is a domain name with a dot, unless a listed origin has this host. The
// owner of a domain can point it at this machine and read responses (DNS rebinding). Throws HttpError 403.
void reject_unknown_host(const Request& request, const std::vector<std::string>& origins);

// Adds the headers that let pages of a listed origin read the response. `exposed`: names of headers that they
// may read in addition to those of all endpoints.
void allow_origin(const Request& request, const std::vector<std::string>& origins,
                  std::span<const std::string_view> exposed, Response& response);

}  // namespace orrery
