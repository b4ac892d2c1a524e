#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/http/message.h"
#include "server/http/network.h"

namespace orrery {

// What proxies in front of the service say of a request: Forwarded (RFC 7239), X-Forwarded-For, -Host and
// -Prefix. Only proxies that are trusted are believed.
class Forwarding {
 public:
  Forwarding() = default;  // there are none
  // trusted_proxies: addresses and networks. path_prefix: what all addresses begin with for clients, such as
  // "/render"; empty: nothing. Throws InputError without a place.
  Forwarding(const std::vector<std::string>& trusted_proxies, std::string_view path_prefix);

  bool trusts(const IpAddress& peer) const;

  // Fills request.client, prefix and told_host of what came from `peer`, and takes the prefix off its path,
  // if the proxy has not. The client is the last one of the list that is no trusted proxy. Where Forwarded
  // and X-Forwarded-For name two, one of them comes from the client itself, and `peer` is taken for it. The
  // path of what was asked of the prefix itself, without a slash after it, is then empty.
  void apply(const IpAddress& peer, Request& request) const;

 private:
  IpAddress client_of(const IpAddress& peer, const std::vector<std::string>& hops) const;
  IpAddress client_of(const IpAddress& peer, const Request& request) const;

  std::vector<IpNetwork> trusted_;
  std::string prefix_;
};

}  // namespace orrery
