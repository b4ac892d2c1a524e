#pragma once

#include "server/app/access.h"
#include "server/http/message.h"

namespace orrery {

// Clients that may see a response: everyone, holders of a token, or holders of a signed link.
enum class AccessLevel { all, holders, link };

// Authorizes a request by its token or, for the scope read, by a signed link. Sets request.client to the name
// of the token and removes the link's parameters from the query. Throws HttpError 401 or 403.
AccessLevel require_access(const Access& access, Scope needed, Request& request);

// Whether the request may remove objects of other clients, which needs a token of the scope admin. Always
// false without tokens, because addresses identify clients then.
bool may_remove_others(const Access& access, const Request& request);

// Whether the query has parameters of a signed link.
bool is_link(const Request& request);
// Returns the query parameters of a signed link: "expires=...&signature=...".
std::string link_parameters(const Access& access, const Request& target, std::int64_t expires);

}  // namespace orrery
