#include "server/http/forwarding.h"

#include <algorithm>

#include "core/base/error.h"
#include "server/http/authority.h"
#include "server/http/field_list.h"
#include "server/http/target.h"

namespace orrery {
namespace {

constexpr std::size_t kLongestPrefix = 200;

// The entries of a header, the nearest proxy's last.
std::vector<std::string> entries_of(const Request& request, std::string_view name) {
  std::vector<std::string> entries;
  for_each_entry(joined(request.headers, name), ',',
                 [&](std::string_view entry) { entries.emplace_back(entry); });
  return entries;
}

// "192.0.2.1", "192.0.2.1:80", "2001:db8::1", "[2001:db8::1]" and "[2001:db8::1]:80"; none for names.
std::optional<IpAddress> address_of(std::string_view node) {
  if (node.starts_with('[')) {
    const std::size_t end = node.find(']');
    return end == std::string_view::npos ? std::nullopt : IpAddress::parse(node.substr(1, end - 1));
  }
  const std::size_t colon = node.find(':');
  const bool has_port = colon != std::string_view::npos && colon == node.rfind(':');
  return IpAddress::parse(has_port ? node.substr(0, colon) : node);
}

// Whether links may begin with it: the path of no other host, without escapes.
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

// The host that the client asked, as the nearest proxy tells it.
std::string host_of(const Request& request) {
  const std::string host = last_of(entries_of(request, "X-Forwarded-Host"));
  const std::string told = last_of(entries_of(request, "Forwarded"));
  return host.empty() ? std::string(parameter_of(told, "host")) : host;
}

}  // namespace

Forwarding::Forwarding(const std::vector<std::string>& trusted_proxies, std::string_view path_prefix)
    : trusted_(trusted_proxies.begin(), trusted_proxies.end()), prefix_(path_prefix) {
  if (prefix_.empty()) return;
  if (!is_prefix(prefix_))
    throw InputError("", "expected a path such as /render, of letters, digits and - . _ ~, at most " +
                             std::to_string(kLongestPrefix) + " bytes, without / at its end, got " +
                             prefix_.substr(0, 80));
  prefix_segments_ = parse_target(prefix_).segments;
}

bool Forwarding::trusts(const IpAddress& peer) const {
  return std::any_of(trusted_.begin(), trusted_.end(),
                     [&](const IpNetwork& network) { return network.contains(peer); });
}

IpAddress Forwarding::client_of(const IpAddress& peer, const std::vector<std::string>& hops) const {
  IpAddress client = peer;
  for (auto hop = hops.rbegin(); hop != hops.rend() && trusts(client); ++hop) {
    const auto address = address_of(*hop);
    if (!address) break;  // the last proxy that is known asks for somebody without an address
    client = *address;
  }
  return client;
}

IpAddress Forwarding::client_of(const IpAddress& peer, const Request& request) const {
  const std::vector<std::string> listed = entries_of(request, "X-Forwarded-For");
  std::vector<std::string> told = entries_of(request, "Forwarded");
  for (std::string& entry : told) entry = std::string(parameter_of(entry, "for"));
  if (told.empty()) return client_of(peer, listed);
  const IpAddress client = client_of(peer, told);
  return listed.empty() || client_of(peer, listed) == client ? client : peer;
}

void Forwarding::take_prefix_off(Request& request) const {
  auto& segments = request.segments;
  if (prefix_.empty() || segments.size() < prefix_segments_.size() ||
      !std::equal(prefix_segments_.begin(), prefix_segments_.end(), segments.begin()))
    return;
  segments.erase(segments.begin(), segments.begin() + static_cast<std::ptrdiff_t>(prefix_segments_.size()));
  if (segments == std::vector<std::string>{""}) segments.clear();  // "/" has none
  request.path.erase(0, prefix_.size());
}

void Forwarding::apply(const IpAddress& peer, Request& request) const {
  request.client = peer.network();
  request.prefix = prefix_;
  if (trusts(peer)) {
    request.client = client_of(peer, request).network();
    const std::string prefix = last_of(entries_of(request, "X-Forwarded-Prefix"));
    if (is_prefix(prefix)) request.prefix = prefix;
    const std::string host = host_of(request);
    if (is_authority(host)) name_host(request.headers, host);
  }
  take_prefix_off(request);
}

}  // namespace orrery
