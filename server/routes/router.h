#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/app/access.h"
#include "server/app/log.h"
#include "server/http/message.h"

namespace orrery {

// The body that a route has read before its handler is called.
struct RouteBody {
  BodyLimit limit;
  void (*require)(const Request&);  // throws what refuses the body by the request's head
};

struct Route {
  using Handler = std::function<Response(Request&)>;

  std::string method, pattern;
  std::vector<std::string> segments;  // of the pattern
  Scope scope;                        // that a token must have
  LogLevel log;                       // of a request that went well
  std::optional<RouteBody> body;      // none: a body is not read
  Handler handler;
};

// Finds the route of a method and a path. Filled once, then const and safe from any thread.
class Router {
 public:
  // `pattern` is a path in which {name} stands for any one segment: "/v1/scenes/{id}/frame.png". A GET route
  // answers HEAD as well. Routes added first are tried first.
  void add(std::string_view method, std::string_view pattern, Scope scope, LogLevel log,
           Route::Handler handler);
  void add(std::string_view method, std::string_view pattern, Scope scope, LogLevel log,
           const RouteBody& body, Route::Handler handler);

  // The route of the request. Fills request.route, also if only the path has one, and request.path_values.
  // Throws HttpError 404 or 405.
  const Route& find(Request& request) const;

  // In the order they were added.
  const std::deque<Route>& routes() const { return routes_; }

  // "GET, HEAD, OPTIONS": the methods that there are for the request's path, for "*" those of all routes (RFC
  // 9110, 9.3.7). Fills as find(). Throws HttpError 404.
  std::string allowed_methods(Request& request) const;

 private:
  static bool matches(const Route& route, Request& request);
  // "PUT /v1/assets/{sha256}, GET ...": routes that name something right below the path; empty if there are
  // none.
  std::string named_below(const Request& request) const;

  std::deque<Route> routes_;  // requests refer to them
};

}  // namespace orrery
