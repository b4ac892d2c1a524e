#include "server/http/router.h"

#include <algorithm>
#include <set>

#include "server/http/target.h"

namespace orrery {
namespace {

bool is_place(std::string_view segment) { return segment.starts_with('{') && segment.ends_with('}'); }

}  // namespace

void Router::add(std::string_view method, std::string_view pattern, Handler handler) {
  routes_.push_back(
      {std::string(method), std::string(pattern), parse_target(pattern).segments, std::move(handler)});
}

bool Router::matches(const Route& route, Request& request) {
  request.path_values.clear();
  if (route.segments.size() != request.segments.size()) return false;
  for (std::size_t i = 0; i < route.segments.size(); ++i) {
    const std::string& wanted = route.segments[i];
    if (is_place(wanted) && !request.segments[i].empty())
      request.path_values.emplace_back(wanted.substr(1, wanted.size() - 2), request.segments[i]);
    else if (wanted != request.segments[i])
      return false;
  }
  return true;
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

Response Router::dispatch(Request& request) const {
  const std::string method = request.method == "HEAD" ? "GET" : request.method;
  const bool all_routes = request.path == "*";
  std::set<std::string> allowed;
  for (const Route& route : routes_) {
    if (!all_routes) {
      if (!matches(route, request)) continue;
      request.route = route.pattern;
      if (route.method == method) return route.handler(request);
    }
    allowed.insert(route.method);
    if (route.method == "GET") allowed.insert("HEAD");
  }
  if (allowed.empty()) {
    const std::string below = named_below(request);
    throw HttpError(404, "There is nothing at " + request.path.substr(0, 200) +
                             (below.empty() ? "" : ", but there is " + below));
  }
  allowed.insert("OPTIONS");
  std::string list;
  for (const std::string& name : allowed) list += (list.empty() ? "" : ", ") + name;
  if (method == "OPTIONS") return Response{.status = 204, .headers = {{"Allow", list}}};
  throw HttpError(405, request.method + " is not possible here, only " + list, {{"Allow", list}});
}

}  // namespace orrery
