#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/params/params.h"
#include "server/app/app.h"
#include "server/http/target.h"
#include "server/routes/access.h"
#include "server/routes/answers.h"

// POST /v1/shares: signs a URL, which then needs no token until it expires.
namespace orrery {
namespace {

Response share(App& app, const Router& router, Request& request) {
  constexpr std::int64_t kLongest_s = 366 * 86400, kUsual_s = 7 * 86400;
  constexpr std::size_t kLongestPath = 1900;  // leaves space for the link parameters in a request target
  std::string path;
  std::int64_t seconds = kUsual_s;
  RequestTrace trace;
  app.read(request.body, caller_of(request), trace, [&](const Document& document, const AssetSource&) {
    read_document(document, [&](Params& p) {
      path = p.text("path", "Path to share; starts with /v1/.", kLongestPath);
      seconds = p.integer("seconds", "Lifetime of the link in seconds.", 1, kLongest_s, kUsual_s);
    });
  });
  for (const std::string& prefix : {request.prefix, app.settings().path_prefix})
    if (path.starts_with(prefix + "/") && !path.starts_with("/v1/")) path.erase(0, prefix.size());
  if (!path.starts_with("/v1/"))
    throw InputError("/path", "must begin with /v1/ (got " + orrery::quoted(path) + ")");
  const bool plain =
      std::all_of(path.begin(), path.end(), [](char c) { return c > ' ' && c < 0x7F && c != '#'; });
  if (!plain)
    throw InputError("/path", "must not contain blanks, # or non-ASCII characters; percent-encode them");
  Request target;
  target.method = "GET";
  try {
    Target parsed = parse_target(path);
    target.path = std::move(parsed.path);
    target.segments = std::move(parsed.segments);
    target.query = std::move(parsed.query);
    if (router.find(target).scope != Scope::read)
      throw HttpError(422,
                      "must be the path of an endpoint with scope read (got " + orrery::quoted(path) + ")");
    if (is_link(target)) throw HttpError(422, "must not be a signed link");
  } catch (const HttpError& error) {
    throw InputError("/path", error.what());
  }
  target.headers = request.headers;
  require_access(app.access(), Scope::read, target);  // the signer needs the access that the link grants
  const std::int64_t expires =
      std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch())
          .count() +
      seconds;
  const std::string separator = path.find('?') == std::string::npos ? "?" : "&";
  Response response = json_answer(
      201, {{"href", request.prefix + path + separator + link_parameters(app.access(), target, expires)},
            {"expires", expires}});
  response.set("Cache-Control", "no-store");
  return response;
}

}  // namespace

void add_shares_routes(Router& router, App& app) {
  router
      .add("POST", "/v1/shares", Scope::write | Scope::read, LogLevel::info, json_body(app),
           [&app, &router](Request& request) { return share(app, router, request); })
      .describe({.id = "share",
                 .summary = "Signs a link, which works without a token until it expires",
                 .body = {"application/json", "ShareRequest"},
                 .answers = {{201, "The link", {}, {{"application/json", "Share"}}}},
                 .errors = {404}});
}

}  // namespace orrery
