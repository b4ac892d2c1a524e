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
// Connections that wait for their client are evicted first. Requests that wait for their turn are next
// (answered 429), then started work or streams that wait to go on. A client with no more connections than the
// newcomer's loses only those that have waited for the client for 100 ms. If no connection can be evicted,
// the newcomer is rejected.
class HttpServer {
 public:
  struct Options {
    std::string host = "127.0.0.1";
    int port = 0;                         // 0: any free port
    std::size_t max_bodies = 256 << 20;   // request bodies being read or used (bodies_bytes)
    std::size_t max_answers = 256 << 20;  // responses being sent (answers_bytes)
    std::size_t max_connections = 256;
    std::size_t handlers = 4;        // that compute at a time (HandlerSlots)
    std::chrono::seconds grace{30};  // for running requests after drain()
    Forwarding forwarding = {};      // trusted proxies may use all connections
  };

  // Result of admission by the request's head.
  struct Admitted {
    std::optional<BodyLimit> body;  // limit of the body to read first; nullopt: no body is read
    std::function<Response(Request&)> answer;
  };

  // Functions that are called on several threads at once. Exceptions of admit() and Admitted::answer() are
  // passed to refuse(); the other functions must not throw.
  struct Handler {
    std::function<Admitted(Request&)> admit;
    // Returns the response to an exception. The request may be incomplete.
    std::function<Response(const Request&, std::exception_ptr)> refuse;
    // Called after each response. `gone`: whether the client had disconnected by then.
    std::function<void(const Request&, const Response&, std::uint64_t bytes, bool gone)> served;
    // Called when `grace` has passed after drain(): running requests must end now.
    std::function<void()> grace_over;
  };

  // Starts to listen. Throws Error if the address is unavailable.
  HttpServer(const Options& options, Handler handler);
  ~HttpServer();

  int port() const;

  std::size_t connections() const;  // open connections
  std::uint64_t refused() const;    // connections rejected for lack of room
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
