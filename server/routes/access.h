#pragma once

#include "server/http/message.h"
#include "server/security/access.h"

namespace orrery {

// Clients that may see a response: all, holders of a token, or holders of a signed link.
enum class AccessLevel { all, holders, link };

// Authorizes a request by its token or, for the scope read, by a signed link. Sets request.client to the name
// of the token. Removes the link parameters from the query. Throws HttpError 401 or 403.
AccessLevel require_access(const Access& access, Scope needed, Request& request);

// Returns whether the request may remove resources of other clients, which needs a token with the scope
// admin. Returns false if the service has no tokens, because clients are then identified only by their
// addresses.
bool may_remove_others(const Access& access, const Request& request);

// Returns whether the query has parameters of a signed link.
bool is_link(const Request& request);
// Returns the query parameters of a signed link: "expires=...&signature=...".
std::string link_parameters(const Access& access, const Request& target, std::int64_t expires);

}  // namespace orrery
