#pragma once

#include <deque>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "server/http/message.h"

namespace orrery {

// Finds the handler for a method and a path. Filled once, then const and safe from any thread.
class Router {
 public:
  using Handler = std::function<Response(Request&)>;

  // `pattern` is a path in which {name} stands for any one segment: "/v1/scenes/{id}/frame.png". A GET route
  // answers HEAD as well. Routes added first are tried first.
  void add(std::string_view method, std::string_view pattern, Handler handler);

  // Fills request.route and request.path_values and calls the handler. OPTIONS without a handler is answered
  // with the methods that there are, for the path "*" with those of all routes (RFC 9110, 9.3.7). Throws
  // HttpError 404 or 405, and what the handler throws.
  Response dispatch(Request& request) const;

 private:
  struct Route {
    std::string method, pattern;
    std::vector<std::string> segments;
    Handler handler;
  };
  static bool matches(const Route& route, Request& request);
  // "PUT /v1/assets/{sha256}, GET ...": routes that name something right below the path; empty if there are
  // none.
  std::string named_below(const Request& request) const;

  std::deque<Route> routes_;  // requests refer to their patterns
};

}  // namespace orrery
