#pragma once

#include <httplib.h>

#include <atomic>
#include <memory>
#include <optional>

#include "server/http/byte_quota.h"
#include "server/http/connection.h"
#include "server/http/hangup_monitor.h"
#include "server/http/response_quota.h"
#include "server/http/server.h"
#include "server/scheduler/handler_slots.h"

namespace orrery {

// Quotas and services that the sessions of all connections share. Thread-safe.
struct SessionServices {
  // `handler` and `monitor` must outlive the services.
  SessionServices(const HttpServer::Options& options, const HttpServer::Handler& of_requests,
                  HangupMonitor& hangups)
      : handler(of_requests),
        monitor(hangups),
        slots(options.handlers),
        bodies(options.max_bodies, "request_buffer_bytes", "request bodies"),
        responses(options.max_answers),
        forwarding(options.forwarding) {}

  const HttpServer::Handler& handler;
  HangupMonitor& monitor;
  HandlerSlots slots;
  ByteQuota bodies;
  ResponseQuota responses;
  const Forwarding forwarding;
  std::atomic<bool> draining{false};  // connections close after their next response
};

// Serves the requests of one connection, one after the other. cpp-httplib parses each request from the
// connection and writes the response to it. For the thread of the connection.
class Session final : private httplib::Server {
 public:
  // `services` and `connection` must outlive the session.
  Session(SessionServices& services, Connection& connection);
  ~Session() override;

  // Reads the next request and writes its response. Returns false if the connection must close. Throws
  // std::bad_alloc if there is no memory for a response.
  bool exchange();

 private:
  struct Work;
  struct Exchange;

  // Called by cpp-httplib, in this order. The last one runs before the response is written.
  void begin(httplib::Request& raw);
  HandlerResponse answer_without_body(httplib::Response& raw);
  void answer_with_body(httplib::Response& raw, const httplib::ContentReader& reader);
  void finish_headers(httplib::Response& raw) const;

  bool reject_head(std::exception_ptr error);
  Body read_body(const httplib::ContentReader& reader);
  void answer();
  // Returns the response to an exception that the request caused.
  Response refuse(std::exception_ptr error) const;
  // Hands the response over to cpp-httplib.
  void respond(httplib::Response& raw);
  bool stream_to(httplib::DataSink& sink);  // returns false if the body is incomplete

  SessionServices& services_;
  Connection& connection_;
  std::unique_ptr<Exchange> exchange_;  // current request; null between two
};

}  // namespace orrery
