#include "server/routes/access.h"

#include <algorithm>
#include <chrono>

#include "core/base/number.h"

namespace orrery {
namespace {

constexpr std::string_view kExpires = "expires", kSignature = "signature";
// Query parameter that needs the scope render. It can make a render a thousand times slower without changing
// a pixel.
constexpr std::string_view kChosen = "accelerator";

// Returns a canonical text of the URL, without the link parameters and independent of percent-encoding.
std::string address_of(const Request& request) {
  std::string text = request.path;
  for (const auto& [name, value] : request.query) {
    if (name == kExpires || name == kSignature) continue;
    text += '\n' + name + '=' + value;
  }
  return text;
}

// Returns true for a valid signed link, false for other requests. Throws HttpError 403 if the link is invalid
// or expired.
bool pass_by_link(const Access& access, Request& request) {
  const auto signature = find_field(request.query, kSignature);
  if (!signature) return false;
  const auto expires = parse_number<std::int64_t>(find_field(request.query, kExpires).value_or(""));
  if (!expires || !access.is_signed(address_of(request), *expires, *signature))
    throw HttpError(403, "link signature is invalid");
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  if (std::chrono::duration_cast<std::chrono::seconds>(now).count() > *expires)
    throw HttpError(403, "link has expired");
  std::erase_if(request.query,
                [](const auto& field) { return field.first == kExpires || field.first == kSignature; });
  return true;
}

std::string_view bearer_of(std::string_view header) {
  constexpr std::string_view kBearer = "Bearer ";
  if (!starts_with_ignoring_case(header, kBearer)) return {};
  return header.substr(kBearer.size());
}

}  // namespace

AccessLevel require_access(const Access& access, Scope needed, Request& request) {
  if (needed == Scope::none) return AccessLevel::all;
  if (needed == Scope::read && pass_by_link(access, request)) return AccessLevel::link;
  if (!access.needs_token()) return AccessLevel::all;
  const std::string header = request.header("Authorization").value_or("");
  const auto holder = access.holder_of(bearer_of(header));
  if (!holder)
    throw HttpError(401, header.empty() ? "missing token (Authorization: Bearer)" : "unknown token",
                    {{"WWW-Authenticate", header.empty() ? "Bearer" : "Bearer error=\"invalid_token\""}});
  if (const auto scope = missing_scope(holder->scopes, needed))
    throw HttpError(403, "token lacks scope " + std::string(*scope));
  if (find_field(request.query, kChosen) && missing_scope(holder->scopes, Scope::render))
    throw HttpError(403, "token lacks scope render, which the parameter " + std::string(kChosen) + " needs");
  request.client = holder->name;
  return AccessLevel::holders;
}

bool may_remove_others(const Access& access, const Request& request) {
  if (!access.needs_token()) return false;
  const auto holder = access.holder_of(bearer_of(request.header("Authorization").value_or("")));
  return holder && !missing_scope(holder->scopes, Scope::admin);
}

bool is_link(const Request& request) {
  return find_field(request.query, kExpires) || find_field(request.query, kSignature);
}

std::string link_parameters(const Access& access, const Request& target, std::int64_t expires) {
  return std::string(kExpires) + "=" + std::to_string(expires) + "&" + std::string(kSignature) + "=" +
         access.sign(address_of(target), expires);
}

}  // namespace orrery
