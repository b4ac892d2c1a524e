#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "server/http/shared_bytes.h"

// What routes see of HTTP. No library shows through.
namespace orrery {

struct Route;

// Names and values in the order they came.
using Fields = std::vector<std::pair<std::string, std::string>>;

// The value of the first field of that name, whatever its case.
std::optional<std::string> find_field(const Fields& fields, std::string_view name);

class App;

// The bytes of a request's body. Routes cannot read them: only App::read() and App::add_asset() can, which
// open the client's memory account, take a turn where that takes long, and stop once the client has gone.
class Body {
 public:
  Body() = default;
  explicit Body(std::string bytes) : bytes_(std::move(bytes)) {}
  bool empty() const { return bytes_.empty(); }
  std::size_t size() const { return bytes_.size(); }

 private:
  friend class App;
  std::string bytes_;
};

// How long a body may be.
struct BodyLimit {
  std::size_t bytes;
  const char* name;  // in /v1/limits
};

struct Request {
  std::string method;                 // "HEAD" is answered as "GET", without the body
  std::string path;                   // decoded
  std::vector<std::string> segments;  // of the path, each decoded
  const Route* route = nullptr;       // whose path it has; null: none has
  std::string id;         // of this request: sent by the client, or made up; letters, digits, . _ -
  std::string client;     // who asks: the address, or what it is known as
  std::string told_host;  // that the client asked, by a proxy; "": none told
  std::string prefix;     // what paths begin with for the client, which `path` does not: "" or "/render"
  Fields query;           // decoded; names are unique
  Fields path_values;     // of the route's {places}
  Fields headers;
  Body body;  // if the route has one read
  std::chrono::steady_clock::time_point start;

  std::stop_token gone;  // requested once the client has gone

  std::optional<std::string> header(std::string_view name) const { return find_field(headers, name); }
  // REQUIRES: the route has that place.
  const std::string& path_value(std::string_view name) const;
};

// Where the parts of a long answer go.
class Sink {
 public:
  virtual ~Sink() = default;
  // Writes all three, one after the other, and waits. False: the client has gone. Throws OverLimit if too
  // much is being sent already.
  virtual bool write(std::string_view bytes, const SharedBytes& more = {}, std::string_view end = {}) = 0;
};

struct Response {
  int status = 200;
  Fields headers = {};
  SharedBytes body = {};
  SharedBytes gzip = {};  // the body compressed, where that is kept; empty: not made
  // Instead of a body: called once, writes the parts as they come to be and returns at the end. Throws if it
  // cannot go on: the answer is then broken off, so that nobody takes it for a whole one, and the log says
  // why.
  std::function<void(Sink&)> stream = {};
  // For the log: rays traced for this answer, and what went wrong inside.
  std::uint64_t rays = 0;
  std::string note = {};
  const char* refusal = nullptr;  // the limit that refused the request, or "draining" if the service ends

  Response& set(std::string_view name, std::string value);  // replaces
};

Response text_response(int status, std::string_view type, SharedBytes body);
Response json_response(int status, std::string json);

// A refusal that is about HTTP itself.
class HttpError : public Error {
 public:
  // limit: the name of the one that was hit, if one was, which lives as long as the program.
  HttpError(int status, const std::string& detail, Fields headers = {}, const char* limit = nullptr)
      : Error(detail), status_(status), headers_(std::move(headers)), limit_(limit) {}
  int status() const noexcept { return status_; }
  const Fields& headers() const noexcept { return headers_; }
  const char* limit() const noexcept { return limit_; }

 private:
  int status_;
  Fields headers_;
  const char* limit_;
};

// "Not Found"
std::string_view reason_phrase(int status);

bool equal_ignoring_case(std::string_view a, std::string_view b);
bool starts_with_ignoring_case(std::string_view text, std::string_view beginning);

}  // namespace orrery
