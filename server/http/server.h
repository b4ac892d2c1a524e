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

// An HTTP/1.1 server: sockets, threads and bytes. What requests mean is the handler's matter. The connections
// of one network take at most three quarters of all. When all are taken, a new one evicts one of the client
// that has most: first one that waits for its client, then one whose request waits for its turn (answered
// 429), then one whose work or stream has begun and waits to go on. Of a client that has no more than the
// newcomer's, only connections that have waited for their client for a while are evicted. If there is none,
// the newcomer is told to come back.
class HttpServer {
 public:
  struct Options {
    std::string host = "127.0.0.1";
    int port = 0;                         // 0: a free one
    std::size_t max_bodies = 256 << 20;   // of all that are read or used at one time (bodies_bytes)
    std::size_t max_answers = 256 << 20;  // of all that are sent at one time (answers_bytes)
    std::size_t max_connections = 256;
    std::size_t handlers = 4;        // that compute at one time on connections' threads (HandlerSlots)
    std::chrono::seconds grace{30};  // for running requests once drain() was called
    Forwarding forwarding = {};      // its trusted proxies may take all connections
  };

  // A request that was judged by its head: what is left to be done.
  struct Admitted {
    std::optional<BodyLimit> body;  // of the body that is read first; none: none is read
    std::function<Response(Request&)> answer;
  };

  // All are called on several threads at once. What admit() and Admitted::answer() throw is handed
  // to refuse(); the others throw nothing.
  struct Handler {
    std::function<Admitted(Request&)> admit;
    // The answer to what was thrown about a request, which may not even be understood as one.
    std::function<Response(const Request&, std::exception_ptr)> refuse;
    // After the answer: bytes sent, and whether the client had left by then.
    std::function<void(const Request&, const Response&, std::uint64_t bytes, bool gone)> served;
    // When the grace after drain() is over: running requests must end now.
    std::function<void()> grace_over;
  };

  // Listens at once. Throws Error if the address cannot be had.
  HttpServer(const Options& options, Handler handler);
  ~HttpServer();

  int port() const;

  std::size_t connections() const;  // that are open
  std::uint64_t refused() const;    // connections, because there were too many
  bool exhausted() const;           // a new client's connection would be refused

  // Accepts connections until drain() was called and the last request was answered.
  void run();

  // Ends idle connections, those with half a request after a last call, and each other one after its next
  // answer. New connections are served until run() returns, so that those who ask learn that the service
  // ends. From any thread.
  void drain();

 private:
  class Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace orrery
