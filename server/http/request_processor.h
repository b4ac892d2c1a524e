#pragma once

#include <atomic>

#include "server/http/byte_quota.h"
#include "server/http/connection.h"
#include "server/http/hangup_monitor.h"
#include "server/http/response_writer.h"
#include "server/http/server.h"
#include "server/scheduler/handler_slots.h"

namespace orrery {

// Handles one request on a connection: head, admission, body, handler, response. Thread-safe.
class RequestProcessor {
 public:
  // `handler` and `monitor` must outlive the processor.
  RequestProcessor(const HttpServer::Options& options, const HttpServer::Handler& handler,
                   HangupMonitor& monitor)
      : handler_(handler),
        monitor_(monitor),
        slots_(options.handlers),
        bodies_(options.max_bodies, "request_buffer_bytes", "request bodies"),
        answers_(options.max_answers),
        forwarding_(options.forwarding) {}

  // Reads the next request and writes its response. Returns false if the connection must close. Throws only
  // std::bad_alloc and similar errors.
  bool exchange(Connection& connection);

  // Closes each connection after its next response.
  void drain() { draining_ = true; }

 private:
  // Returns the response to an exception that the request caused.
  Response refuse(const Connection& connection, const Request& request, std::exception_ptr error) const;
  bool send(Connection& connection, const Request& request, Response response, Framing framing);

  const HttpServer::Handler& handler_;
  HangupMonitor& monitor_;
  HandlerSlots slots_;
  ByteQuota bodies_;
  ResponseQuota answers_;
  const Forwarding forwarding_;
  std::atomic<bool> draining_{false};
};

}  // namespace orrery
