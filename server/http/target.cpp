#include "server/http/target.h"

#include <algorithm>
#include <cctype>

#include "server/http/authority.h"

namespace orrery {
namespace {

int digit_of(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// Returns the length of the UTF-8 sequence (RFC 3629) at `i`, or 0 if it is invalid.
std::size_t utf8_length(std::string_view text, std::size_t i) {
  const auto byte = [&](std::size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0u; };
  const unsigned lead = byte(i);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4) return 0;
  for (std::size_t k = 1; k < length; ++k)
    if ((byte(i + k) & 0xC0) != 0x80) return 0;
  const unsigned second = byte(i + 1);
  const bool overlong = (lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90);
  const bool beyond = (lead == 0xED && second > 0x9F) || (lead == 0xF4 && second > 0x8F);
  return overlong || beyond ? 0 : length;
}

void require_clean(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text, i);
    if (length == 0) throw HttpError(400, "URL must be valid UTF-8");
    if (length == 1 && (static_cast<unsigned char>(text[i]) < 0x20 || text[i] == 0x7F))
      throw HttpError(400, "URL must not contain a control character");
    i += length;
  }
}

std::string decode(std::string_view text, bool plus_is_space) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '+' && plus_is_space) {
      decoded += ' ';
    } else if (text[i] != '%') {
      decoded += text[i];
    } else {
      const int high = i + 2 < text.size() ? digit_of(text[i + 1]) : -1;
      const int low = i + 2 < text.size() ? digit_of(text[i + 2]) : -1;
      if (high < 0 || low < 0) throw HttpError(400, "each % in the URL must precede two hexadecimal digits");
      decoded += static_cast<char>(high * 16 + low);
      i += 2;
    }
  }
  require_clean(decoded);
  return decoded;
}

// Calls `part` with each piece of `text` between separators, also with empty ones.
template <class Part>
void split(std::string_view text, char separator, const Part& part) {
  for (;;) {
    const std::size_t end = text.find(separator);
    part(text.substr(0, end));
    if (end == std::string_view::npos) return;
    text.remove_prefix(end + 1);
  }
}

Fields parse_query(std::string_view text) {
  Fields query;
  split(text, '&', [&](std::string_view pair) {
    if (pair.empty()) return;
    const std::size_t equals = pair.find('=');
    std::string name = decode(pair.substr(0, equals), true);
    std::string value = equals == std::string_view::npos ? "" : decode(pair.substr(equals + 1), true);
    if (std::any_of(query.begin(), query.end(), [&](const auto& field) { return field.first == name; }))
      throw HttpError(400, "duplicate query parameter \"" + name.substr(0, 40) + "\"");
    query.emplace_back(std::move(name), std::move(value));
  });
  return query;
}

// Removes "http://host:port" from the front of `target` and returns "host:port". Returns "" if there is no
// scheme.
std::string_view take_authority(std::string_view& target) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (!equal_ignoring_case(target.substr(0, scheme.size()), scheme)) continue;
    target.remove_prefix(scheme.size());
    const std::string_view authority = target.substr(0, target.find_first_of("/?"));
    if (!is_authority(authority))
      throw HttpError(
          400, "URL authority must be HOST or HOST:PORT (got " + std::string(authority.substr(0, 100)) + ")");
    target.remove_prefix(authority.size());
    return authority;
  }
  return {};
}

}  // namespace

Target parse_target(std::string_view target) {
  target = target.substr(0, target.find('#'));
  Target parsed;
  parsed.authority = take_authority(target);
  const std::size_t mark = target.find('?');
  std::string_view path = target.substr(0, mark);
  if (path.empty() && !parsed.authority.empty()) path = "/";
  if (!path.starts_with('/'))
    throw HttpError(400, "URL path must begin with / (got " + std::string(path.substr(0, 100)) + ")");
  parsed.path = decode(path, false);
  path.remove_prefix(1);
  if (!path.empty())
    split(path, '/', [&](std::string_view segment) { parsed.segments.push_back(decode(segment, false)); });
  if (mark != std::string_view::npos) parsed.query = parse_query(target.substr(mark + 1));
  return parsed;
}

std::string query_text(const Fields& query) {
  std::string text;
  const auto add = [&](std::string_view part) {
    constexpr std::string_view kHex = "0123456789ABCDEF", kUnreserved = "-._~";
    for (const unsigned char c : part)
      if (std::isalnum(c) || kUnreserved.find(static_cast<char>(c)) != std::string_view::npos)
        text += static_cast<char>(c);
      else
        text += {'%', kHex[c / 16], kHex[c % 16]};
  };
  for (const auto& [name, value] : query) {
    text += text.empty() ? '?' : '&';
    add(name);
    text += '=';
    add(value);
  }
  return text;
}

}  // namespace orrery
