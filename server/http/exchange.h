#pragma once

#include <atomic>

#include "server/http/budget.h"
#include "server/http/connection.h"
#include "server/http/server.h"

namespace orrery {

struct Exchange;

// One request and its answer, on any connection: from bytes to the handler and back to bytes. Safe from any
// thread.
class Exchanger {
 public:
  // `handler` outlives it.
  Exchanger(const HttpServer::Options& options, const HttpServer::Handler& handler);

  // Reads and answers the request that begins there. False if the connection ends with it. Throws nothing but
  // std::bad_alloc and its like.
  bool exchange(Connection& connection);

  // From now on connections end with their next answer.
  void drain() { draining_ = true; }

 private:
  void take(Exchange& exchange);

  const std::size_t max_body_;
  const HttpServer::Handler& handler_;
  Budget bodies_;
  std::atomic<bool> draining_{false};
};

}  // namespace orrery
