#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "server/http/message.h"

namespace orrery {

inline constexpr std::size_t kMaxHeadBytes = 16 * 1024;
inline constexpr std::size_t kMaxTargetBytes = 2 * 1024;
inline constexpr std::size_t kMaxHeaders = 100;

// Validated request line and headers. Ambiguous requests are rejected, so that proxies and this server always
// read the same request.
struct Head {
  std::string method, target;
  int minor_version = 1;  // HTTP/1.0 or 1.1
  Fields headers;         // values are trimmed
  std::optional<std::size_t> content_length;
  bool chunked = false;    // Transfer-Encoding: chunked
  bool keep_alive = true;  // the connection may stay open after the response

  std::optional<std::string> header(std::string_view name) const { return find_field(headers, name); }
};

bool is_token(std::string_view text);  // RFC 9110, 5.6.2
// Whether `text` is a valid field value: visible characters, blanks, tabs and bytes above ASCII.
bool is_field_text(std::string_view text);

// Parses the bytes up to and including the empty line (RFC 9112) strictly. Lines must end with CR LF, names
// must be tokens, and folded lines are rejected. Accepts one Host, which may be empty, and at most one
// Content-Length (digits only) or one Transfer-Encoding (chunked). Throws HttpError 400, 414, 431, 501 or
// 505.
Head parse_head(std::string_view bytes);

// Throws an error of parse_head() before the head is complete. Rejects TLS handshakes, HTTP/0.9 lines and
// lines that end with LF without CR. `bytes`: input so far, at most up to the empty line. The bytes before
// `from` were screened by an earlier call.
void screen_head(std::string_view bytes, std::size_t from);

}  // namespace orrery
