#include "server/http/cors.h"

#include <algorithm>

namespace orrery {
namespace {

bool is_listed(const Request& request, const std::vector<std::string>& origins) {
  const auto origin = request.header("Origin");
  return origin && std::any_of(origins.begin(), origins.end(),
                               [&](const std::string& listed) { return listed == "*" || listed == *origin; });
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

void allow_origin(const Request& request, const std::vector<std::string>& origins, Response& response) {
  if (origins.empty()) return;
  const std::string vary = find_field(response.headers, "Vary").value_or("");
  response.set("Vary", vary.empty() ? "Origin" : vary + ", Origin");
  if (!is_listed(request, origins)) return;
  response.set("Access-Control-Allow-Origin", *request.header("Origin"));
  response.set("Access-Control-Expose-Headers",
               "ETag, Location, Retry-After, Server-Timing, X-Rays, X-Request-ID");
}

}  // namespace orrery
