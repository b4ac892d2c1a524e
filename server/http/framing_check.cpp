#include "server/http/framing_check.h"

#include <algorithm>
#include <array>

#include "core/base/number.h"
#include "core/base/shorten.h"
#include "server/http/authority.h"
#include "server/http/field_list.h"

namespace orrery {
namespace {

// CONNECT is missing because its target has the unsupported authority form (RFC 9112, 3.2.3).
constexpr std::array<std::string_view, 8> kMethods{"GET",    "HEAD",    "POST",  "PUT",
                                                   "DELETE", "OPTIONS", "TRACE", "PATCH"};

// Headers that are not passed on: cpp-httplib serves ranges without If-Range, and adds the other four.
constexpr std::array<std::string_view, 5> kWithheld{"Range", "REMOTE_ADDR", "REMOTE_PORT", "LOCAL_ADDR",
                                                    "LOCAL_PORT"};

// State between two lines of a head.
struct Head {
  int minor_version = 1;  // HTTP/1.0 or 1.1
  int headers = 0, hosts = 0;
  CheckedHead checked;
};

[[noreturn]] void throw_too_long() {
  throw HttpError(414, "URL has more than " + grouped(kMaxTargetBytes) + " bytes (limit " +
                           grouped(kMaxTargetBytes) + ", address_bytes)");
}

void check_request_line(std::string_view line, Head& head) {
  const std::size_t first = line.find(' '), last = line.rfind(' ');
  if (first == std::string_view::npos || first == last)
    throw HttpError(400, "request line must be METHOD PATH HTTP/1.1");
  const std::string_view method = line.substr(0, first), version = line.substr(last + 1);
  const std::string_view target = line.substr(first + 1, last - first - 1);
  if (!is_token(method)) throw HttpError(400, "method must be a token (RFC 9110, 5.6.2)");
  if (target.size() > kMaxTargetBytes) throw_too_long();
  const bool visible =
      std::all_of(target.begin(), target.end(), [](char c) { return c > 0x20 && c != 0x7F; });
  if (target.empty() || !visible)
    throw HttpError(400, "URL must not be empty or contain unescaped blanks or control characters");
  const std::string_view before_fragment = target.substr(0, target.find('#'));
  if (std::count(before_fragment.begin(), before_fragment.end(), '?') > 1)
    throw HttpError(400, "URL must have at most one unescaped ?");
  if (version != "HTTP/1.1" && version != "HTTP/1.0") {
    if (version.starts_with("HTTP/"))
      throw HttpError(505,
                      "HTTP version must be 1.1 or 1.0 (got " + std::string(version.substr(0, 40)) + ")");
    throw HttpError(400, "request line must be METHOD PATH HTTP/1.1");
  }
  if (std::find(kMethods.begin(), kMethods.end(), method) == kMethods.end())
    throw HttpError(501, "unknown method " + std::string(method.substr(0, 40)));
  head.minor_version = version.back() - '0';
  head.checked.bytes.append(line).append("\r\n");
}

void check_transfer_coding(std::string_view coding, Head& head) {
  if (head.minor_version == 0) throw HttpError(400, "Transfer-Encoding cannot be used with HTTP/1.0");
  if (head.checked.chunked) throw HttpError(400, "duplicate Transfer-Encoding header");
  if (!equal_ignoring_case(coding, "chunked"))
    throw HttpError(501, "Transfer-Encoding must be chunked (got " + std::string(coding.substr(0, 40)) + ")");
  head.checked.chunked = true;
}

void check_length(std::string_view value, Head& head) {
  const auto length = parse_number<std::size_t>(value);
  if (!length)
    throw HttpError(
        400, "Content-Length must be a number of bytes (got " + std::string(value.substr(0, 40)) + ")");
  if (head.checked.content_length) throw HttpError(400, "duplicate Content-Length header");
  head.checked.content_length = *length;
}

void check_host(std::string_view value, Head& head) {
  ++head.hosts;
  if (!value.empty() && !is_authority(value))
    throw HttpError(
        400, "Host must be a host with an optional port (got " + std::string(value.substr(0, 100)) + ")");
}

// Appends the header as cpp-httplib must read it.
void pass_on(std::string_view name, std::string_view value, std::string& bytes) {
  if (std::any_of(kWithheld.begin(), kWithheld.end(),
                  [&](std::string_view withheld) { return equal_ignoring_case(withheld, name); }))
    return;
  const std::size_t begin = bytes.size();
  bytes.append(name).append(": ");
  for (const char c : value)
    if (c == '%')
      bytes += "%25";
    else
      bytes += c;
  bytes += "\r\n";
  if (bytes.size() - begin > kMaxHeaderBytes)
    throw HttpError(431, "header " + std::string(name.substr(0, 40)) + " has more than " +
                             grouped(kMaxHeaderBytes) + " bytes (limit " + grouped(kMaxHeaderBytes) +
                             ", header_bytes; % counts as 3)");
}

void check_header(std::string_view line, Head& head) {
  if (head.headers++ == kMaxHeaders)
    throw HttpError(431, "request has more than " + std::to_string(kMaxHeaders) + " headers (limit " +
                             std::to_string(kMaxHeaders) + ")");
  const std::size_t colon = line.find(':');
  const std::string_view name = line.substr(0, colon);
  if (colon == std::string_view::npos || !is_token(name)) throw HttpError(400, "header must be NAME: VALUE");
  const std::string_view value = trimmed(line.substr(colon + 1));
  if (!is_field_text(value))
    throw HttpError(400,
                    "header " + std::string(name.substr(0, 40)) + " must not contain control characters");
  if (equal_ignoring_case(name, "Host")) check_host(value, head);
  if (equal_ignoring_case(name, "Transfer-Encoding")) check_transfer_coding(value, head);
  if (equal_ignoring_case(name, "Content-Length")) check_length(value, head);
  pass_on(name, value, head.checked.bytes);
}

}  // namespace

bool is_token(std::string_view text) {
  constexpr std::string_view kMarks = "!#$%&'*+-.^_`|~";
  return !text.empty() && std::all_of(text.begin(), text.end(), [&](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           kMarks.find(c) != std::string_view::npos;
  });
}

bool is_field_text(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte == '\t' || (byte >= 0x20 && byte != 0x7F);
  });
}

CheckedHead check_head(std::string_view bytes) {
  Head head;
  bool first = true;
  while (!bytes.empty()) {
    const std::size_t end = bytes.find("\r\n");
    if (end == std::string_view::npos) throw HttpError(400, "line must end with CR LF");
    const std::string_view line = bytes.substr(0, end);
    bytes.remove_prefix(end + 2);
    if (line.empty()) break;
    if (first)
      check_request_line(line, head);
    else
      check_header(line, head);
    first = false;
  }
  if (first) throw HttpError(400, "request line is missing");
  if (head.checked.chunked && head.checked.content_length)
    throw HttpError(400, "Content-Length cannot be used with Transfer-Encoding");
  if (head.hosts > 1 || (head.hosts == 0 && head.minor_version == 1))
    throw HttpError(400, "request must have one Host header (got " + std::to_string(head.hosts) + ")");
  head.checked.bytes += "\r\n";
  return std::move(head.checked);
}

void screen_head(std::string_view bytes, std::size_t from) {
  for (std::size_t i = from; i < bytes.size(); ++i) {
    const auto byte = static_cast<unsigned char>(bytes[i]);
    const bool after_cr = i > 0 && bytes[i - 1] == '\r';
    if (after_cr != (byte == '\n')) throw HttpError(400, "line must end with CR LF");
    if ((byte < 0x20 && byte != '\t' && byte != '\r' && byte != '\n') || byte == 0x7F)
      throw HttpError(400, "request headers must not contain control characters");
  }
  constexpr std::size_t kAroundTarget = 20;  // bytes; method, blanks and version take fewer
  const std::size_t end = bytes.find("\r\n");
  Head head;
  if (end != std::string_view::npos && end + 2 > from) check_request_line(bytes.substr(0, end), head);
  if (end == std::string_view::npos && bytes.size() > kMaxTargetBytes + kAroundTarget) throw_too_long();
}

}  // namespace orrery
