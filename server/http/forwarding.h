#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/http/message.h"
#include "server/http/network.h"

namespace orrery {

// Request data reported by reverse proxies: Forwarded (RFC 7239), X-Forwarded-For, -Host and -Prefix. Headers
// of untrusted peers are ignored.
class Forwarding {
 public:
  Forwarding() = default;  // no proxies
  // `trusted_proxies`: addresses and networks. `path_prefix`: path prefix that clients see, such as
  // "/render"; may be empty. Throws InputError with an empty pointer.
  Forwarding(const std::vector<std::string>& trusted_proxies, std::string_view path_prefix);

  bool trusts(const IpAddress& peer) const;

  // Sets client, prefix and forwarded_host of a request from `peer`. Strips the prefix from its path unless
  // the proxy has stripped it. The client is the last listed address that is not a trusted proxy. If
  // Forwarded and X-Forwarded-For name different clients, one may be forged, and `peer` becomes the client. A
  // request for the prefix itself without a trailing slash gets an empty path.
  void apply(const IpAddress& peer, Request& request) const;

 private:
  IpAddress client_of(const IpAddress& peer, const std::vector<std::string>& hops) const;
  IpAddress client_of(const IpAddress& peer, const Request& request) const;

  std::vector<IpNetwork> trusted_;
  std::string prefix_;
};

}  // namespace orrery
