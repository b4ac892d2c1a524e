#pragma once

#include <string>

#include "server/http/connection.h"
#include "server/http/message.h"
#include "server/http/response_quota.h"

namespace orrery {

// Message framing of a response (RFC 9112, 6).
struct Framing {
  bool head_only = false;  // the request was HEAD: no body follows
  int minor_version = 1;   // HTTP/1.x of the request; HTTP/1.0 has no chunks
  bool keep_alive = true;  // false: the connection closes after the response
};

// Returns the status line and headers up to and including the empty line. Adds Content-Length,
// Transfer-Encoding and Connection, which `response` must not have. Replaces control characters in values
// with blanks, so that a value cannot start another header.
std::string response_head(const Response& response, const Framing& framing);

// Whether a body, possibly empty, follows the head of the response.
bool has_body(const Response& response, const Framing& framing);

// Client of a response, and the quota for its bytes.
struct Sender {
  ResponseQuota& answers;
  std::string client;
  std::stop_token gone = {};  // stop requested when the client disconnects
};

// Writes the response. Returns false if the client has disconnected or if `response.stream` threw. In the
// second case, `response.note` is the text of the exception. A stream ends when the client disconnects. Its
// bytes count against `sender.answers`. REQUIRES: keep_alive is false for a stream to an HTTP/1.0 client.
bool write_response(Connection& connection, Response& response, const Framing& framing, const Sender& sender);

}  // namespace orrery
