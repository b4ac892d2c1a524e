#include "server/http/authority.h"

#include <algorithm>

#include "server/http/message.h"
#include "server/http/network.h"

namespace orrery {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_hexadecimal(char c) { return is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F'); }

bool is_name(std::string_view text) {  // reg-name; includes all IPv4 addresses
  constexpr std::string_view kMarks = "-._~!$&'()*+,;=";
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    const bool escape =
        c == '%' && i + 2 < text.size() && is_hexadecimal(text[i + 1]) && is_hexadecimal(text[i + 2]);
    if (!letter && !is_digit(c) && !escape && kMarks.find(c) == std::string_view::npos) return false;
  }
  return !text.empty();
}

bool is_ipv6(std::string_view text) {
  return text.find(':') != std::string_view::npos && IpAddress::parse(text);
}

bool is_port(std::string_view text) {
  int port = 0;
  for (const char c : text) {
    if (!is_digit(c)) return false;
    port = std::min(port * 10 + (c - '0'), 65536);
  }
  return port <= 65535;
}

}  // namespace

bool is_address_or_localhost(std::string_view text) {
  if (text.starts_with('[')) return true;
  const std::string_view host = text.substr(0, text.find(':'));
  return equal_ignoring_case(host, "localhost") || IpAddress::parse(host);
}

bool is_origin(std::string_view text) {
  const std::size_t colon = text.find("://");
  const std::string_view scheme = text.substr(0, std::min(colon, text.size()));
  const bool lower = std::none_of(text.begin(), text.end(), [](char c) { return c >= 'A' && c <= 'Z'; });
  const bool letters = std::all_of(scheme.begin(), scheme.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || is_digit(c) || c == '+' || c == '-' || c == '.';
  });
  return colon != std::string_view::npos && colon > 0 && lower && letters &&
         is_authority(text.substr(colon + 3));
}

bool is_authority(std::string_view text) {
  std::string_view host = text.substr(0, text.find(':'));
  if (text.starts_with('[')) {
    const std::size_t end = text.find(']');
    if (end == std::string_view::npos || !is_ipv6(text.substr(1, end - 1))) return false;
    host = text.substr(0, end + 1);
  } else if (!is_name(host)) {
    return false;
  }
  const std::string_view rest = text.substr(host.size());
  return rest.empty() || (rest.front() == ':' && is_port(rest.substr(1)));
}

}  // namespace orrery
