#pragma once

#include <string>

#include "server/http/answer_budget.h"
#include "server/http/connection.h"
#include "server/http/message.h"

namespace orrery {

// How an answer is framed (RFC 9112, 6): by what its request was, and whether another may follow it.
struct Framing {
  bool head_only = false;  // the request was HEAD: no body follows
  int minor_version = 1;   // of the request: HTTP/1.0 knows no chunks
  bool keep_alive = true;  // false: the connection ends after the answer
};

// Status line and headers up to and with the empty line, Content-Length, Transfer-Encoding and Connection
// among them; `response` has none of these. Control characters in a value become blanks, so that no value
// can begin a header of its own.
std::string response_head(const Response& response, const Framing& framing);

// Whether a body follows the head of the answer, or would if it were not empty.
bool has_body(const Response& response, const Framing& framing);

// For whom an answer is sent.
struct Sender {
  AnswerBudget& answers;
  std::string client;
  std::stop_token gone = {};  // requested once the client has gone
};

// Writes all of the answer and returns true; false: the client has left, or `response.stream` threw, which
// `response.note` then tells. A stream ends once the client has gone; what it writes counts among the
// answers. REQUIRES: keep_alive is false if a stream answers HTTP/1.0.
bool write_response(Connection& connection, Response& response, const Framing& framing, const Sender& sender);

}  // namespace orrery
