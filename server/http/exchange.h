#pragma once

#include <atomic>
#include <memory>

#include "server/http/budget.h"
#include "server/http/connection.h"
#include "server/http/hangup_monitor.h"
#include "server/http/server.h"

namespace orrery {

struct Exchange;

// One request and its answer, on any connection: from bytes to the handler and back to bytes. Safe from any
// thread.
class Exchanger {
 public:
  // `handler` and `monitor` must outlive it.
  Exchanger(const HttpServer::Options& options, const HttpServer::Handler& handler, HangupMonitor& monitor);
  ~Exchanger();

  // Reads and answers the request that begins there. False if the connection ends with it. Throws nothing but
  // std::bad_alloc and its like.
  bool exchange(Connection& connection);

  // From now on connections end with their next answer.
  void drain() { draining_ = true; }

 private:
  class Engine;
  void take(Exchange& exchange);

  const std::size_t max_body_;
  const HttpServer::Handler& handler_;
  HangupMonitor& monitor_;
  Budget bodies_;
  std::atomic<bool> draining_{false};
  const std::unique_ptr<Engine> engine_;
};

}  // namespace orrery
