#pragma once

#include <atomic>

#include "server/http/budget.h"
#include "server/http/connection.h"
#include "server/http/handler_slots.h"
#include "server/http/hangup_monitor.h"
#include "server/http/response_writer.h"
#include "server/http/server.h"

namespace orrery {

// One request and its answer, on any connection, in one direction: head, admission, body, handler, answer.
// Safe from any thread.
class Exchanger {
 public:
  // `handler` and `monitor` must outlive it.
  Exchanger(const HttpServer::Options& options, const HttpServer::Handler& handler, HangupMonitor& monitor)
      : handler_(handler),
        monitor_(monitor),
        slots_(options.handlers),
        bodies_(options.max_bodies, "bodies_bytes", "Bodies of requests"),
        answers_(options.max_answers),
        forwarding_(options.forwarding) {}

  // Reads and answers the request that begins there. False if the connection ends with it. Throws nothing but
  // std::bad_alloc and its like.
  bool exchange(Connection& connection);

  // From now on connections end with their next answer.
  void drain() { draining_ = true; }

 private:
  // The answer to what was thrown about the request.
  Response refuse(const Connection& connection, const Request& request, std::exception_ptr error) const;
  bool send(Connection& connection, const Request& request, Response response, Framing framing);

  const HttpServer::Handler& handler_;
  HangupMonitor& monitor_;
  HandlerSlots slots_;
  Budget bodies_;
  AnswerBudget answers_;
  const Forwarding forwarding_;
  std::atomic<bool> draining_{false};
};

}  // namespace orrery
