#pragma once

#include "server/app/app.h"
#include "server/app/log.h"
#include "server/app/metrics.h"
#include "server/http/server.h"
#include "server/routes/router.h"

namespace orrery {

// The whole service: app, routes and HTTP servers: one for all, and one for health and metrics with threads
// of its own, so that nothing can silence it. Both listen once it is made.
class Service {
 public:
  // Throws Error if an address cannot be had, InputError for files that cannot be used.
  Service(const Settings& settings, const Log& log);

  int port() const { return server_.port(); }
  int health_port() const { return health_.port(); }
  // Serves until stop() was called and what ran then is done.
  void run();
  // Both from any thread.
  void stop();  // after drain_delay_seconds
  // Reads the files of tokens and keys again, unless `read` returns the names of others, and takes the
  // cors_origins of what it returns. The log names the other settings that differ, which need a restart, or
  // says what was thrown: then all stays as it is.
  void reload(const std::function<Settings()>& read);

 private:
  HttpServer::Handler handler_of(const Router& router);
  HttpServer::Admitted admit(const Router& router, Request& request);
  Response refuse(const Request& request, std::exception_ptr error) const;
  Response finished(const Request& request, Response response) const;
  Response metrics();
  std::vector<std::string> origins() const;
  void note(const Request& request, const Response& response, std::uint64_t bytes, bool gone);

  const Settings settings_;  // as they were given
  const Log& log_;
  SteadyTimer timer_;
  App app_;
  Metrics metrics_;
  mutable std::mutex mutex_;
  std::vector<std::string> origins_;  // guarded by mutex_
  Router router_, health_router_;
  HttpServer server_, health_;  // their threads use the others
  std::unique_ptr<Timer::Alarm> drain_;
};

}  // namespace orrery
