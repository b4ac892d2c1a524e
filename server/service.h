#pragma once

#include "server/app/app.h"
#include "server/app/log.h"
#include "server/http/router.h"
#include "server/http/server.h"

namespace orrery {

// The whole service: app, routes and HTTP server. It listens once it is made.
class Service {
 public:
  // Throws Error if the address cannot be had.
  Service(const Settings& settings, const Log& log);

  int port() const { return server_.port(); }
  // Serves until stop() was called and what ran then is done.
  void run();
  // From any thread.
  void stop();

 private:
  Response answer(Request& request);
  void note(const Request& request, const Response& response, std::uint64_t bytes, bool gone) const;

  const Log& log_;
  App app_;
  Router router_;
  HttpServer server_;  // last: its threads use the others
};

}  // namespace orrery
