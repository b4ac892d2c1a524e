#pragma once

#include "server/app/access.h"
#include "server/http/message.h"

namespace orrery {

// Who may see the answer: all, all who show a token, or who has the link.
enum class Audience { all, holders, link };

// Lets a request pass that shows a token of the scope it needs or, to read, a signed link, or needs neither;
// notes who it is from. A link's own parameters are taken out of the query. Throws HttpError 401 or 403.
Audience require_access(const Access& access, Scope needed, Request& request);

// Whether the request may remove what other clients made, which takes a token of the scope admin. Without
// tokens, nobody may: there clients are known by their addresses.
bool may_remove_others(const Access& access, const Request& request);

// Whether the address has parameters of a link.
bool is_link(const Request& request);
// The parameters that make an address a link: "expires=...&signature=...".
std::string link_parameters(const Access& access, const Request& target, std::int64_t expires);

}  // namespace orrery
