#include "server/http/forwarding.h"

#include <algorithm>

#include "core/base/error.h"
#include "server/http/authority.h"
#include "server/http/field_list.h"
#include "server/http/framing_check.h"
#include "server/http/target.h"

namespace orrery {
namespace {

constexpr std::size_t kLongestPrefix = 200;
constexpr const char* kNobody = "for=unknown";  // RFC 7239, 6.3

// Returns the entries of a header. The last entry is the nearest proxy's.
std::vector<std::string> entries_of(const Request& request, std::string_view name) {
  std::vector<std::string> entries;
  std::string list = joined(request.headers, name);
  for (char& c : list)
    if (c == '"') c = ' ';  // ignored: a client's open quote would hide entries that a proxy has appended
  for_each_entry(list, ',', [&](std::string_view entry) { entries.emplace_back(entry); });
  return entries;
}

// Returns the entries of Forwarded. The last entry is the nearest proxy's. Lines are parsed separately, so
// that a client's open quote ends with its line. A line that ends within quotes becomes one unknown entry.
std::vector<std::string> entries_of_forwarded(const Request& request) {
  std::vector<std::string> entries;
  for (const auto& [name, line] : request.headers) {
    if (!equal_ignoring_case(name, "Forwarded")) continue;
    if (ends_in_quotes(line))
      entries.emplace_back(kNobody);
    else
      for_each_entry(line, ',', [&](std::string_view entry) { entries.emplace_back(entry); });
  }
  return entries;
}

// Returns the `for` node of an entry of Forwarded, or "" if the entry has no `for`.
std::string node_of(const std::string& entry) {
  const std::string_view node = parameter_of(entry, "for");
  if (!node.empty()) return std::string(node);
  bool named = false;
  for_each_entry(entry, ';', [&](std::string_view pair) {
    named = named || equal_ignoring_case(trimmed(pair.substr(0, pair.find('='))), "for");
  });
  return named ? "unknown" : "";  // empty or repeated `for`
}

// Whether `text` is a port of 1 to 5 digits or an obfuscated port that begins with _ (RFC 7239, 6.2).
bool is_node_port(std::string_view text) {
  constexpr std::size_t kMaxDigits = 5;
  const bool number =
      text.size() <= kMaxDigits && text.find_first_not_of("0123456789") == std::string_view::npos;
  return !text.empty() && (number || (text.front() == '_' && is_token(text)));
}

// Parses "192.0.2.1", "192.0.2.1:80", "2001:db8::1", "[2001:db8::1]" and "[2001:db8::1]:80". Returns nullopt
// for names and for unspecified addresses.
std::optional<IpAddress> address_of(std::string_view node) {
  std::string_view host = node, rest;
  if (node.starts_with('[')) {
    const std::size_t end = node.find(']');
    if (end == std::string_view::npos) return std::nullopt;
    host = node.substr(1, end - 1);
    rest = node.substr(end + 1);
  } else if (const std::size_t colon = node.find(':'); colon == node.rfind(':')) {
    host = node.substr(0, colon);
    rest = node.substr(host.size());
  }
  if (!rest.empty() && (rest.front() != ':' || !is_node_port(rest.substr(1)))) return std::nullopt;
  const auto address = IpAddress::parse(host);
  return address == IpAddress() || address == IpAddress::parse("0.0.0.0") ? std::nullopt : address;
}

// Whether `text` is valid as a prefix of links: an absolute path without escapes that cannot name a host.
bool is_prefix(std::string_view text) {
  constexpr std::string_view kMarks = "-._~/";
  const bool plain = std::all_of(text.begin(), text.end(), [&](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           kMarks.find(c) != std::string_view::npos;
  });
  return plain && text.starts_with('/') && !text.ends_with('/') && text.size() <= kLongestPrefix &&
         text.find("//") == std::string_view::npos && text.find("/.") == std::string_view::npos;
}

std::string last_of(const std::vector<std::string>& entries) { return entries.empty() ? "" : entries.back(); }

// Returns the host that the client requested, as reported by the nearest proxy.
std::string host_of(const Request& request) {
  const std::string host = last_of(entries_of(request, "X-Forwarded-Host"));
  const std::string told = last_of(entries_of_forwarded(request));
  return host.empty() ? std::string(parameter_of(told, "host")) : host;
}

// Strips the prefix from the path. Returns false if the path does not begin with it.
bool strip_prefix(std::string_view prefix, Request& request) {
  if (prefix.empty()) return false;
  const std::vector<std::string> wanted = parse_target(prefix).segments;
  auto& segments = request.segments;
  if (segments.size() < wanted.size() || !std::equal(wanted.begin(), wanted.end(), segments.begin()))
    return false;
  segments.erase(segments.begin(), segments.begin() + static_cast<std::ptrdiff_t>(wanted.size()));
  if (segments == std::vector<std::string>{""}) segments.clear();  // "/" has no segments
  request.path.erase(0, prefix.size());
  return true;
}

}  // namespace

Forwarding::Forwarding(const std::vector<std::string>& trusted_proxies, std::string_view path_prefix)
    : trusted_(trusted_proxies.begin(), trusted_proxies.end()), prefix_(path_prefix) {
  if (prefix_.empty()) return;
  if (!is_prefix(prefix_))
    throw InputError("", "must be a path such as /render with only letters, digits and - . _ ~ /, at most " +
                             std::to_string(kLongestPrefix) + " bytes and no trailing / (got " +
                             prefix_.substr(0, 80) + ")");
}

bool Forwarding::trusts(const IpAddress& peer) const {
  return std::any_of(trusted_.begin(), trusted_.end(),
                     [&](const IpNetwork& network) { return network.contains(peer); });
}

IpAddress Forwarding::client_of(const IpAddress& peer, const std::vector<std::string>& hops) const {
  IpAddress client = peer;
  for (auto hop = hops.rbegin(); hop != hops.rend() && trusts(client); ++hop) {
    const auto address = address_of(*hop);
    if (!address) break;  // the last known proxy reports a client without an address
    client = *address;
  }
  return client;
}

IpAddress Forwarding::client_of(const IpAddress& peer, const Request& request) const {
  const std::vector<std::string> listed = entries_of(request, "X-Forwarded-For");
  std::vector<std::string> told = entries_of_forwarded(request);
  for (std::string& entry : told) entry = node_of(entry);
  const bool names_nobody =
      std::all_of(told.begin(), told.end(), [](const auto& node) { return node.empty(); });
  if (names_nobody) return client_of(peer, listed);
  const IpAddress client = client_of(peer, told);
  return listed.empty() || client_of(peer, listed) == client ? client : peer;
}

void Forwarding::apply(const IpAddress& peer, Request& request) const {
  request.client = peer.network();
  request.prefix = prefix_;
  if (trusts(peer)) {
    request.client = client_of(peer, request).network();
    const std::string prefix = last_of(entries_of(request, "X-Forwarded-Prefix"));
    if (is_prefix(prefix)) request.prefix = prefix;
    request.forwarded_host = host_of(request);
  }
  if (!strip_prefix(request.prefix, request)) strip_prefix(prefix_, request);
}

}  // namespace orrery
