#include "server/routes/router.h"

#include <algorithm>
#include <set>

#include "server/http/target.h"

namespace orrery {
namespace {

bool is_place(std::string_view segment) { return segment.starts_with('{') && segment.ends_with('}'); }

}  // namespace

Route& Router::add(std::string_view method, std::string_view pattern, Scope scope, LogLevel log,
                   Route::Handler handler) {
  return routes_.emplace_back(Route{.method = std::string(method),
                                    .pattern = std::string(pattern),
                                    .segments = parse_target(pattern).segments,
                                    .scope = scope,
                                    .log = log,
                                    .body = {},
                                    .handler = std::move(handler)});
}

Route& Router::add(std::string_view method, std::string_view pattern, Scope scope, LogLevel log,
                   const RouteBody& body, Route::Handler handler) {
  Route& route = add(method, pattern, scope, log, std::move(handler));
  route.body = body;
  return route;
}

std::string Router::named_below(const Request& request) const {
  std::string list;
  for (const Route& route : routes_) {
    if (route.segments.size() != request.segments.size() + 1 || !is_place(route.segments.back())) continue;
    if (!std::equal(request.segments.begin(), request.segments.end(), route.segments.begin())) continue;
    list += (list.empty() ? "" : ", ") + route.method + " " + route.pattern;
  }
  return list;
}

bool Router::matches(const Route& route, Request& request) {
  if (route.segments.size() != request.segments.size()) return false;
  Fields values;
  for (std::size_t i = 0; i < route.segments.size(); ++i) {
    const std::string& wanted = route.segments[i];
    if (is_place(wanted) && !request.segments[i].empty())
      values.emplace_back(wanted.substr(1, wanted.size() - 2), request.segments[i]);
    else if (wanted != request.segments[i])
      return false;
  }
  request.route = &route;
  request.path_values = std::move(values);
  return true;
}

const Route& Router::find(Request& request) const {
  const std::string_view method = request.method == "HEAD" ? "GET" : std::string_view(request.method);
  for (const Route& route : routes_)
    if (route.method == method && matches(route, request)) return route;
  const std::string allowed = allowed_methods(request);
  throw HttpError(405, "method must be one of " + allowed + " (got " + request.method + ")",
                  {{"Allow", allowed}});
}

std::string Router::allowed_methods(Request& request) const {
  std::set<std::string> methods;
  for (const Route& route : routes_) {
    if (request.path != "*" && !matches(route, request)) continue;
    methods.insert(route.method);
    if (route.method == "GET") methods.insert("HEAD");
  }
  if (methods.empty()) {
    const std::string below = named_below(request);
    throw HttpError(404, "unknown path " + request.path.substr(0, 200) +
                             (below.empty() ? "" : " (did you mean " + below + "?)"));
  }
  methods.insert("OPTIONS");
  std::string list;
  for (const std::string& name : methods) list += (list.empty() ? "" : ", ") + name;
  return list;
}

}  // namespace orrery
