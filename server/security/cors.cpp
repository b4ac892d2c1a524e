#include "server/security/cors.h"

#include <algorithm>
#include <array>

#include "server/http/authority.h"

namespace orrery {
namespace {

bool is_listed(const Request& request, const std::vector<std::string>& origins) {
  const auto origin = request.header("Origin");
  return origin && std::any_of(origins.begin(), origins.end(),
                               [&](const std::string& listed) { return listed == "*" || listed == *origin; });
}

// Throws HttpError 403 if `host` is a domain name with a dot, unless a listed origin has this host.
void require_known(const std::string& host, const std::vector<std::string>& origins) {
  const bool listed = std::any_of(origins.begin(), origins.end(), [&](const std::string& origin) {
    return origin == "*" || equal_ignoring_case(origin.substr(origin.find("//") + 2), host);
  });
  const bool may_be_owned = host.find('.') != std::string::npos;  // by the owner of a public domain
  if (!listed && may_be_owned && !is_address_or_localhost(host))
    throw HttpError(403, "Host must be an IP address, localhost or the host of one of cors_origins (got " +
                             host.substr(0, 100) + ")");
}

}  // namespace

std::optional<Response> preflight(const Request& request, const std::vector<std::string>& origins) {
  if (request.method != "OPTIONS" || !request.header("Access-Control-Request-Method")) return std::nullopt;
  if (!is_listed(request, origins)) return std::nullopt;
  Response response{.status = 204};
  response.set("Access-Control-Allow-Methods", "GET, HEAD, POST, PUT, DELETE");
  response.set("Access-Control-Allow-Headers",
               "Authorization, Content-Type, Idempotency-Key, If-None-Match, Last-Event-ID, X-Request-ID");
  response.set("Access-Control-Max-Age", "600");
  return response;
}

void reject_cross_origin(const Request& request, const std::vector<std::string>& origins, bool domains) {
  constexpr std::array<std::string_view, 3> kSafe{"GET", "HEAD", "OPTIONS"};
  const auto origin = request.header("Origin");
  if (!origin || std::find(kSafe.begin(), kSafe.end(), request.method) != kSafe.end()) return;
  const std::string host =
      request.forwarded_host.empty() ? request.header("Host").value_or("") : request.forwarded_host;
  const std::size_t slashes = origin->find("//");
  const bool own = slashes != std::string::npos && equal_ignoring_case(origin->substr(slashes + 2), host) &&
                   (domains || is_address_or_localhost(host));
  if (!own && !is_listed(request, origins))
    throw HttpError(403, "Origin of a request that changes data must be one of cors_origins (got " +
                             origin->substr(0, 100) + ")");
}

void reject_unknown_host(const Request& request, const std::vector<std::string>& origins) {
  require_known(request.header("Host").value_or(""), origins);
  require_known(request.forwarded_host, origins);  // may come from the client if the proxy does not set it
}

void allow_origin(const Request& request, const std::vector<std::string>& origins,
                  std::span<const std::string_view> exposed, Response& response) {
  if (origins.empty()) return;
  const std::string vary = find_field(response.headers, "Vary").value_or("");
  response.set("Vary", vary.empty() ? "Origin" : vary + ", Origin");
  if (!is_listed(request, origins)) return;
  response.set("Access-Control-Allow-Origin", *request.header("Origin"));
  std::string names =
      "Content-Location, ETag, Location, Orrery-Asset-Id, Orrery-Model-Notes, Orrery-Scene-Id, Retry-After, "
      "Server-Timing, "
      "X-Request-ID";
  for (const std::string_view name : exposed) names.append(", ").append(name);
  response.set("Access-Control-Expose-Headers", std::move(names));
}

}  // namespace orrery
