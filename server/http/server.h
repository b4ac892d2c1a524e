#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "server/http/forwarding.h"
#include "server/http/message.h"

namespace orrery {

// An HTTP/1.1 server: sockets, threads and parsing. The handler interprets the requests. One network may have
// at most three quarters of the connections.
//
// When all connections are in use, a new one evicts a connection of the client with the most connections.
// Connections that wait for their client are evicted first, then requests that wait for a handler slot
// (status 429), then started requests and streams that wait for other threads. A client that has at most as
// many connections as the newcomer's client loses only those that have waited for the client for 100 ms. If
// no connection can be evicted, the newcomer is rejected.
class HttpServer {
 public:
  struct Options {
    std::string host = "127.0.0.1";
    int port = 0;                         // 0: any free port
    std::size_t max_bodies = 256 << 20;   // request bodies being read or used (request_buffer_bytes)
    std::size_t max_answers = 256 << 20;  // responses being sent (response_buffer_bytes)
    std::size_t max_connections = 256;
    std::size_t handlers = 4;        // maximum that compute at the same time
    std::chrono::seconds grace{30};  // time for running requests after drain()
    Forwarding forwarding = {};      // trusted proxies may use all connections
  };

  // Result of the admission of a request, after its head is read.
  struct Admitted {
    std::optional<BodyLimit> body;  // limit of the body to read first; nullopt: no body is read
    std::function<Response(Request&)> answer;
  };

  // Functions that are called on several threads at the same time. Exceptions of admit() and
  // Admitted::answer() are passed to refuse(). The other functions must not throw.
  struct Handler {
    std::function<Admitted(Request&)> admit;
    // Returns the response to an exception. The request may be incomplete.
    std::function<Response(const Request&, std::exception_ptr)> refuse;
    // Called after each response. `gone`: whether the client had disconnected by then.
    std::function<void(const Request&, const Response&, std::uint64_t bytes, bool gone)> served;
    // Called when `grace` has passed after drain(): running requests must end now.
    std::function<void()> grace_over;
  };

  // Starts listening. Throws Error if the address is unavailable.
  HttpServer(const Options& options, Handler handler);
  ~HttpServer();

  int port() const;

  std::size_t connections() const;  // open connections
  std::uint64_t refused() const;    // connections rejected because too many were open
  bool exhausted() const;           // whether a new client's connection would be rejected

  // Accepts connections until drain() is called and the last request is answered.
  void run();

  // Begins a graceful shutdown. Closes idle connections at once, incomplete requests after
  // Timeouts::shutdown_grace and other connections after their next response. New connections are served
  // until run() returns, so that clients learn of the shutdown. Thread-safe.
  void drain();

 private:
  class Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace orrery
