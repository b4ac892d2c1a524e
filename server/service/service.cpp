#include "server/service/service.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/base/version.h"
#include "server/api/results.h"
#include "server/http/compression.h"
#include "server/http/process_limits.h"
#include "server/http/target.h"
#include "server/routes/access.h"
#include "server/routes/problem.h"
#include "server/routes/routes.h"
#include "server/security/cors.h"
#include "server/service/metrics_snapshot.h"

namespace orrery {
namespace {

// Returns the current time as an HTTP date (RFC 9110, 5.6.7), such as "Sun, 06 Nov 1994 08:49:37 GMT".
// Ignores the locale.
std::string http_date() {
  constexpr const char* kDays[] = {"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
  constexpr const char* kMonths[] = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                     "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  const std::time_t now = std::time(nullptr);
  std::tm t{};
  gmtime_r(&now, &t);
  char text[64];
  std::snprintf(text, sizeof text, "%s, %02d %s %d %02d:%02d:%02d GMT", kDays[t.tm_wday], t.tm_mday,
                kMonths[t.tm_mon], t.tm_year + 1900, t.tm_hour, t.tm_min, t.tm_sec);
  return text;
}

// Returns at most 200 bytes of the query for the log, without the signature of a link.
std::string query_of(const Request& request) {
  std::string text;
  for (const auto& [name, value] : request.query)
    if (name != "signature") text += (text.empty() ? "" : "&") + name + "=" + value;
  return text.substr(0, 200);
}

void add_common_headers(const Request& request, Response& response) {
  response.set("X-Request-ID", request.id)
      .set("Date", http_date())
      .set("Server", "orrery/" + std::string(kVersion))
      .set("X-Content-Type-Options", "nosniff")
      .set("Referrer-Policy", "no-referrer")
      .set("Content-Security-Policy", "default-src 'self'");
}

// Makes public responses private unless anyone may see them. Caches must also revalidate responses to signed
// links, so that no cached copy outlives its link.
void keep_private(AccessLevel audience, Response& response) {
  const std::string kept = find_field(response.headers, "Cache-Control").value_or("");
  constexpr std::string_view kPublic = "public, ";
  if (audience == AccessLevel::link && !kept.empty() && kept != "no-store")
    response.set("Cache-Control", "private, no-cache");
  else if (audience != AccessLevel::all && kept.starts_with(kPublic))
    response.set("Cache-Control", "private, " + kept.substr(kPublic.size()));
}

HttpServer::Options options_of(const Settings& settings) {
  return {.host = settings.host,
          .port = settings.port,
          .max_bodies = std::max(
              {settings.request_buffer_bytes, settings.max_request_body_bytes, settings.asset_bytes}),
          .max_answers = settings.response_buffer_bytes,
          .max_connections = settings.connections,
          .handlers = std::max<std::size_t>(2, std::thread::hardware_concurrency()),
          .grace = settings.grace_seconds,
          .forwarding = {settings.trusted_proxies, settings.path_prefix}};
}

HttpServer::Options health_options_of(const Settings& settings) {
  return {.host = settings.health_host,
          .port = settings.health_port,
          .max_bodies = 0,
          .max_connections = kHealthConnections,
          .handlers = kHealthConnections,
          .grace = std::chrono::seconds(1),
          .forwarding = {}};
}

}  // namespace

Service::Service(const Settings& settings, const Log& log)
    : settings_(settings),
      log_(log),
      app_(settings, timer_),
      origins_(settings.cors_origins),
      server_(options_of(settings), handler_of(router_)),
      health_(health_options_of(settings), handler_of(health_router_)) {
  app_.watch_connections([this] { return std::string_view(server_.exhausted() ? "full" : "ok"); });
  add_routes(router_, app_);
  add_health_routes(health_router_, app_);
  health_router_.add("GET", "/metrics", Scope::none, LogLevel::debug, [this](Request&) { return metrics(); });
}

HttpServer::Handler Service::handler_of(const Router& router) {
  return {
      .admit = [this, &router](Request& request) { return admit(router, request); },
      .refuse = [this](const Request& request, std::exception_ptr error) { return refuse(request, error); },
      .served = [this](const Request& request, const Response& response, std::uint64_t bytes,
                       bool gone) { note(request, response, bytes, gone); },
      .grace_over = [this] { app_.end(); }};
}

void Service::run() {
  std::thread health([this] { health_.run(); });
  server_.run();
  health_.drain();
  health.join();
}

void Service::reload(const std::function<Settings()>& read) try {
  const Settings fresh = read();
  if (fresh.tokens_file == settings_.tokens_file &&
      fresh.link_signing_key_file == settings_.link_signing_key_file)
    app_.access().reload();
  nlohmann::ordered_json fields = nlohmann::ordered_json::object();
  if (app_.access().needs_token()) fields["tokens"] = app_.access().tokens();
  for (const Setting& setting : all_settings())
    if (setting.name != "cors_origins" && setting.text(fresh) != setting.text(settings_))
      fields["needs_restart"].push_back(setting.name);
  {
    const std::lock_guard lock(mutex_);
    origins_ = fresh.cors_origins;
  }
  log_.write(fields.contains("needs_restart") ? LogLevel::warning : LogLevel::info, "reloaded", fields);
} catch (const std::exception& error) {
  ++app_.meters().reloads_failed;
  log_.write(LogLevel::error, "reload failed", {{"error", error.what()}});
}

std::vector<std::string> Service::origins() const {
  const std::lock_guard lock(mutex_);
  return origins_;
}

void Service::stop() {
  const auto delay = app_.settings().drain_delay_seconds;
  log_.write(LogLevel::info, "draining", {{"delay_s", delay.count()}});
  app_.retire();
  drain_.reset(new Timer::Alarm(timer_.at(timer_.now() + delay, [this] {
    app_.drain();
    server_.drain();
  })));
}

Response Service::metrics() {
  return text_response(200, "text/plain; version=0.0.4; charset=utf-8",
                       metrics_.text(collect_metrics(app_, server_, log_)))
      .set("Cache-Control", "no-store");
}

HttpServer::Admitted Service::admit(const Router& router, Request& request) {
  const std::vector<std::string> origins = this->origins();
  const auto answered = [this](const Response& response) -> HttpServer::Admitted {
    return {.body = {}, .answer = [this, response](Request& r) { return finished(r, response); }};
  };
  if (request.path.empty())  // relative links of the page need the final slash
    return answered(
        {.status = 308,
         .headers = {{"Location", "/" + query_text(request.query)}, {"Cache-Control", "no-store"}}});
  if (const auto answer = preflight(request, origins)) return answered(*answer);
  reject_cross_origin(request, origins, !settings_.tokens_file.empty());
  if (request.method == "OPTIONS")
    return answered({.status = 204, .headers = {{"Allow", router.allowed_methods(request)}}});
  const Route& route = router.find(request);
  if (route.scope != Scope::none && settings_.tokens_file.empty() && !settings_.insecure)
    reject_unknown_host(request, origins);
  const AccessLevel audience = require_access(app_.access(), route.scope, request);
  HttpServer::Admitted admitted{.body = {}, .answer = [this, &route, audience](Request& r) {
                                  Response response = route.handler(r);
                                  keep_private(audience, response);
                                  return finished(r, std::move(response));
                                }};
  if (!route.body) return admitted;
  route.body->require(request);
  admitted.body = route.body->limit;
  return admitted;
}

Response Service::refuse(const Request& request, std::exception_ptr error) const {
  return finished(request, problem_response(error, request.id));
}

Response Service::finished(const Request& request, Response response) const {
  compress(request, response);
  add_common_headers(request, response);
  if (const auto location = find_field(response.headers, "Location"))
    response.set("Location", request.prefix + *location);
  allow_origin(request, origins(), result_header_names(&ResultOutputs::image), response);
  return response;
}

void Service::note(const Request& request, const Response& response, std::uint64_t bytes, bool gone) {
  const double ms = milliseconds_since(request.start);
  metrics_.count_request(request.route ? request.route->pattern : "", request.method, response.status,
                         ms / 1000, bytes, gone);
  if (response.refusal) metrics_.count_refusal(response.refusal);
  nlohmann::ordered_json fields = {{"id", request.id},
                                   {"client", request.client},
                                   {"method", request.method},
                                   {"path", request.path.substr(0, 200)},
                                   {"status", response.status},
                                   {"ms", std::round(ms * 1000) / 1000},
                                   {"bytes", bytes}};
  if (const std::string query = query_of(request); !query.empty()) fields["query"] = query;
  if (response.rays > 0) fields["rays"] = response.rays;
  if (response.refusal) fields["refused_by"] = response.refusal;
  if (gone) fields["client_left"] = true;
  if (!response.note.empty()) fields["error"] = response.note;
  const bool failed = response.status == 500 || !response.note.empty();
  const LogLevel usual = request.route ? request.route->log : LogLevel::info;
  log_.write(failed ? LogLevel::error : usual, "request", fields);
}

}  // namespace orrery
