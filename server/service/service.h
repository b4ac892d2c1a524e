#pragma once

#include "server/app/app.h"
#include "server/http/server.h"
#include "server/routes/router.h"
#include "server/telemetry/log.h"
#include "server/telemetry/metrics.h"

namespace orrery {

// The app, its routes and two HTTP servers. The second server answers health and metrics requests on its own
// threads, so load on the first cannot block it. Both servers listen once the constructor returns.
class Service {
 public:
  // Throws Error if an address is unavailable, InputError if a file in the settings cannot be used.
  Service(const Settings& settings, const Log& log);

  int port() const { return server_.port(); }
  int health_port() const { return health_.port(); }
  // Serves requests until stop() is called and the running requests have ended.
  void run();
  // Starts draining after drain_delay_seconds. Safe from any thread.
  void stop();
  // Reads the token and key files again, unless read() returns other file names. Takes cors_origins from the
  // result of read(). Logs the names of other changed settings, which need a restart. If reading fails, logs
  // the error and changes nothing. Safe from any thread.
  void reload(const std::function<Settings()>& read);

 private:
  HttpServer::Handler handler_of(const Router& router);
  HttpServer::Admitted admit(const Router& router, Request& request);
  Response refuse(const Request& request, std::exception_ptr error) const;
  Response finished(const Request& request, Response response) const;
  Response metrics();
  std::vector<std::string> origins() const;
  void note(const Request& request, const Response& response, std::uint64_t bytes, bool gone);

  const Settings settings_;  // as passed to the constructor
  const Log& log_;
  SteadyTimer timer_;
  App app_;
  Metrics metrics_;
  mutable std::mutex mutex_;
  std::vector<std::string> origins_;  // guarded by mutex_
  Router router_, health_router_;
  HttpServer server_, health_;  // their threads use the members above
  std::unique_ptr<Timer::Alarm> drain_;
};

}  // namespace orrery
