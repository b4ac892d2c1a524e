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
#include "server/base/shared_bytes.h"

// HTTP messages as routes see them, independent of any library.
namespace orrery {

struct Route;

// Names and values of header fields or query parameters, in order of arrival.
using Fields = std::vector<std::pair<std::string, std::string>>;

// Returns the value of the first field with this name, ignoring case, or nullopt.
std::optional<std::string> find_field(const Fields& fields, std::string_view name);

class App;

// Bytes of a request body. Only App::read() and App::add_asset() can read them. These charge memory to the
// client, wait for a slot if the work is long, and stop when the client disconnects.
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

// Maximum length of a body.
struct BodyLimit {
  std::size_t bytes;
  const char* name;  // name in /v1/limits
};

struct Request {
  std::string method;                 // "HEAD" is answered like "GET", without the body
  std::string path;                   // decoded
  std::vector<std::string> segments;  // decoded path segments
  const Route* route = nullptr;       // route with this path, or null
  std::string id;                     // sent by the client or generated; letters, digits, . _ -
  std::string client;                 // network of the client, or name of its token
  std::string forwarded_host;         // host requested by the client according to a proxy, or ""
  std::string prefix;                 // path prefix that clients see, stripped from `path`: "" or "/render"
  Fields query;                       // decoded; names are unique
  Fields path_values;                 // values of the route's {placeholders}
  Fields headers;
  Body body;  // empty unless the route reads a body
  std::chrono::steady_clock::time_point start;

  std::stop_token gone;  // stop requested when the client disconnects

  std::optional<std::string> header(std::string_view name) const { return find_field(headers, name); }
  // REQUIRES: the route has a placeholder with this name.
  const std::string& path_value(std::string_view name) const;
};

// Destination of a streamed response.
class Sink {
 public:
  virtual ~Sink() = default;
  // Writes the three pieces in order and blocks until the kernel has accepted them. Returns false if the
  // client has disconnected. Throws LimitExceeded if `more` exceeds the quota of response bytes.
  virtual bool write(std::string_view bytes, const SharedBytes& more = {}, std::string_view end = {}) = 0;
};

struct Response {
  int status = 200;
  Fields headers = {};
  SharedBytes body = {};
  SharedBytes gzip = {};  // compressed body if cached, or empty
  // Writer of a streamed body, called once instead of sending `body`. If it throws, the response is truncated
  // in a way that the client detects, and the exception is logged.
  std::function<void(Sink&)> stream = {};
  std::uint64_t rays = 0;         // traced for this response, for the log
  std::string note = {};          // text of an internal error for the log, or ""
  const char* refusal = nullptr;  // limit that rejected the request, or "draining" during shutdown

  Response& set(std::string_view name, std::string value);  // replaces the header
};

Response text_response(int status, std::string_view type, SharedBytes body);
Response json_response(int status, std::string json);

// Thrown when a request violates HTTP or a limit. Has the status of the response.
class HttpError : public Error {
 public:
  // `limit`: name of the exceeded limit, or null. Must live as long as the program.
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

// Returns "Not Found" for 404, for instance.
std::string_view reason_phrase(int status);

bool equal_ignoring_case(std::string_view a, std::string_view b);
bool starts_with_ignoring_case(std::string_view text, std::string_view beginning);

}  // namespace orrery
