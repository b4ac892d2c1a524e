#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/http/message.h"
#include "server/routes/operation.h"
#include "server/security/access.h"
#include "server/telemetry/log.h"

namespace orrery {

// Rules for a body, which is read before the handler of the route is called.
struct RouteBody {
  BodyLimit limit;
  void (*require)(const Request&);  // called before the body is read; throws to reject it
};

// Endpoint of the service. `handler` runs on connection threads for several requests at once, so it must be
// thread-safe. problem_response() turns its exceptions into responses.
struct Route {
  using Handler = std::function<Response(Request&)>;

  std::string method, pattern;
  std::vector<std::string> segments;  // segments of the pattern
  Scope scope;                        // scope that the token must have
  LogLevel log;                       // log level of successful requests
  std::optional<RouteBody> body;      // nullopt: no body is read
  Handler handler;
  std::optional<Operation> operation = {};  // nullopt: not in the OpenAPI document

  void describe(Operation described) { operation = std::move(described); }
};

// Finds the route for a method and a path. Thread-safe once all routes are added.
class Router {
 public:
  // Adds a route. In `pattern`, {name} matches one non-empty segment: "/v1/scenes/{id}/frame.png". A GET
  // route also answers HEAD. Routes are tried in order of addition. The returned route can be described.
  Route& add(std::string_view method, std::string_view pattern, Scope scope, LogLevel log,
             Route::Handler handler);
  Route& add(std::string_view method, std::string_view pattern, Scope scope, LogLevel log,
             const RouteBody& body, Route::Handler handler);

  // Returns the route of the request. Sets request.route and request.path_values, also if only the path
  // matches. Throws HttpError 404 or 405.
  const Route& find(Request& request) const;

  // Returns all routes in order of addition.
  const std::deque<Route>& routes() const { return routes_; }

  // Returns the methods of the request's path, such as "GET, HEAD, OPTIONS". For "*", returns those of all
  // routes (RFC 9110, 9.3.7). Sets the same members as find(). Throws HttpError 404 for an unknown path.
  std::string allowed_methods(Request& request) const;

 private:
  static bool matches(const Route& route, Request& request);
  // Returns the routes that extend the path by one placeholder, such as "PUT /v1/assets/{sha256}, GET ...".
  // Returns "" if there are no such routes.
  std::string named_below(const Request& request) const;

  std::deque<Route> routes_;  // a deque, since requests point to its elements
};

}  // namespace orrery
