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

// Request line and headers of a request, checked: whatever stands before a request is read the same way by
// everyone who sees it.
struct Head {
  std::string method, target;
  int minor_version = 1;  // HTTP/1.0 or 1.1
  Fields headers;         // values without blanks around them
  std::optional<std::size_t> content_length;
  bool chunked = false;    // Transfer-Encoding: chunked
  bool keep_alive = true;  // the client does not want the connection closed

  std::optional<std::string> header(std::string_view name) const { return find_field(headers, name); }
};

bool is_token(std::string_view text);  // RFC 9110, 5.6.2
// Visible characters, blanks and bytes above ASCII: what a header's value may have.
bool is_field_text(std::string_view text);

// Parses the bytes up to and with the empty line (RFC 9112), strictly: lines end with CR LF, names are
// tokens, nothing is folded; one Host, which may be empty; at most one Content-Length, digits only, or one
// Transfer-Encoding, which is chunked. Throws HttpError 400, 414, 431, 501 or 505.
Head parse_head(std::string_view bytes);

// Throws what parse_head() would throw as soon as it is sure, so that nobody waits for the end of what is no
// request: a TLS handshake, a line of HTTP/0.9, lines that end with LF. `bytes` are those that have come, at
// most up to the empty line; those before `from` were screened already.
void screen_head(std::string_view bytes, std::size_t from);

}  // namespace orrery
