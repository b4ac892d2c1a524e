#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "server/http/message.h"

namespace orrery {

inline constexpr std::size_t kMaxHeadBytes = 16 * 1024;
inline constexpr std::size_t kMaxHeaderBytes = 8 * 1024;  // one header line, limited by cpp-httplib
inline constexpr std::size_t kMaxTargetBytes = 2 * 1024;
inline constexpr std::size_t kMaxHeaders = 100;

// Request line and headers that cpp-httplib reads the same way as every proxy in front of it.
struct CheckedHead {
  std::string bytes;                          // for cpp-httplib, up to and including the empty line
  std::optional<std::size_t> content_length;  // bytes of the body
  bool chunked = false;                       // Transfer-Encoding: chunked
};

bool is_token(std::string_view text);  // RFC 9110, 5.6.2
// Whether `text` is a valid field value: visible characters, blanks, tabs and bytes above ASCII.
bool is_field_text(std::string_view text);

// Checks the bytes up to and including the empty line (RFC 9112), because cpp-httplib 0.11.4
// - skips lines without CR LF and headers without a colon, so that a proxy may see other headers;
// - takes the first of several Content-Length, Transfer-Encoding and Host headers;
// - reads the leading digits of a Content-Length, and prefers Transfer-Encoding to it;
// - accepts several blanks and control characters around and in header values;
// - rejects a target with two "?" without a reason;
// - has no limit on the number of headers.
// Each of these is an error here. Throws HttpError 400, 414, 431, 501 or 505. The result leaves out headers
// that cpp-httplib would act upon or add itself (Range, REMOTE_ADDR and similar), and escapes "%" in values
// because cpp-httplib decodes them.
CheckedHead check_head(std::string_view bytes);

// Throws an error of check_head() before the head is complete. Rejects TLS handshakes, HTTP/0.9 lines and
// lines that end with LF without CR. `bytes`: input so far, at most up to the empty line. The bytes before
// `from` were screened by an earlier call.
void screen_head(std::string_view bytes, std::size_t from);

}  // namespace orrery
