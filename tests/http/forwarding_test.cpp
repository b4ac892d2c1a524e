#include "server/http/forwarding.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

// Tests how client address, host and path prefix are determined behind proxies.
namespace orrery {
namespace {

IpAddress address(std::string_view text) { return *IpAddress::parse(text); }

// Returns the request after Forwarding has applied `headers` from a proxy with the address `peer`.
Request applied(const Fields& headers, const char* peer = "10.0.0.1", const std::string& prefix = "",
                const std::vector<std::string>& segments = {}) {
  static const std::vector<std::string> kProxies{"10.0.0.0/8", "192.0.2.7", "fd00::/8"};
  Request request;
  request.headers = headers;
  request.segments = segments;
  for (const std::string& segment : segments) request.path += "/" + segment;
  Forwarding(kProxies, prefix).apply(address(peer), request);
  return request;
}
std::string client_of(const Fields& headers, const char* peer = "10.0.0.1") {
  return applied(headers, peer).client;
}

TEST(IpNetwork, ContainsAddressesWithSamePrefix) {
  EXPECT_TRUE(IpNetwork("10.0.0.0/8").contains(address("10.255.0.1")));
  EXPECT_FALSE(IpNetwork("10.0.0.0/8").contains(address("11.0.0.1")));
  EXPECT_TRUE(IpNetwork("10.0.0.128/25").contains(address("10.0.0.129")));
  EXPECT_FALSE(IpNetwork("10.0.0.128/25").contains(address("10.0.0.127")));
  EXPECT_TRUE(IpNetwork("192.0.2.1").contains(address("::ffff:192.0.2.1")));
  EXPECT_FALSE(IpNetwork("192.0.2.1").contains(address("192.0.2.0")));
  EXPECT_TRUE(IpNetwork("0.0.0.0/0").contains(address("1.2.3.4")));
  EXPECT_FALSE(IpNetwork("0.0.0.0/0").contains(address("2001:db8::1")));
  EXPECT_TRUE(IpNetwork("2001:db8::/33").contains(address("2001:db8:7fff::1")));
  EXPECT_FALSE(IpNetwork("2001:db8::/33").contains(address("2001:db8:8000::1")));
  EXPECT_TRUE(IpNetwork("::/0").contains(address("1.2.3.4")));
}

TEST(IpNetwork, RejectsInvalidNetworks) {
  for (const char* text : {"", "proxy", "10.0.0.0/", "10.0.0.0/33", "10.0.0.0/-1", "10.0.0.0/8/8",
                           "10.0.0.1/8", "10.1", "::/129", "fd00::1/8", "10.0.0.0/ 8", " 10.0.0.1"})
    EXPECT_THROW(IpNetwork{text}, InputError) << text;
}

TEST(IpAddress, ReturnsIpv4AddressOrIpv6HalfAsNetwork) {
  EXPECT_EQ(address("192.0.2.1").network(), "192.0.2.1");
  EXPECT_EQ(address("::ffff:192.0.2.1").network(), "192.0.2.1");
  EXPECT_EQ(address("2001:db8:1:2:3:4:5:6").network(), "2001:db8:1:2::");
  EXPECT_EQ(IpAddress().network(), "");
}

TEST(Forwarding, TrustsOnlyListedProxies) {
  const Fields headers{{"X-Forwarded-For", "198.51.100.1"}};
  EXPECT_EQ(client_of(headers), "198.51.100.1");
  EXPECT_EQ(client_of(headers, "192.0.2.7"), "198.51.100.1");
  EXPECT_EQ(client_of(headers, "192.0.2.8"), "192.0.2.8");
  EXPECT_EQ(client_of(headers, "203.0.113.1"), "203.0.113.1");
  EXPECT_EQ(client_of({}), "10.0.0.1");
}

TEST(Forwarding, ReturnsLastUntrustedAddressAsClient) {
  EXPECT_EQ(client_of({{"X-Forwarded-For", "203.0.113.9, 198.51.100.1"}}), "198.51.100.1");
  EXPECT_EQ(client_of({{"X-Forwarded-For", "203.0.113.9, 198.51.100.1,10.9.9.9"}}), "198.51.100.1");
  EXPECT_EQ(client_of({{"X-Forwarded-For", "203.0.113.9"}, {"X-Forwarded-For", "198.51.100.1"}}),
            "198.51.100.1");
  EXPECT_EQ(client_of({{"X-Forwarded-For", "10.1.1.1, 10.9.9.9"}}), "10.1.1.1");
  EXPECT_EQ(client_of({{"X-Forwarded-For", ", 198.51.100.1,, "}}), "198.51.100.1");
}

TEST(Forwarding, ParsesEveryFormOfAddress) {
  EXPECT_EQ(client_of({{"X-Forwarded-For", "198.51.100.1:4711"}}), "198.51.100.1");
  EXPECT_EQ(client_of({{"X-Forwarded-For", "2001:db8:1:2:3::4"}}), "2001:db8:1:2::");
  EXPECT_EQ(client_of({{"X-Forwarded-For", "[2001:db8:1:2:3::4]:80"}}), "2001:db8:1:2::");
  EXPECT_EQ(client_of({{"Forwarded", "for=198.51.100.1"}}), "198.51.100.1");
  EXPECT_EQ(client_of({{"forwarded", "For=\"198.51.100.1:80\";proto=https;by=203.0.113.43"}}),
            "198.51.100.1");
  EXPECT_EQ(client_of({{"Forwarded", "proto=https;for=\"[2001:db8:1:2:3::4]:4711\""}}), "2001:db8:1:2::");
  EXPECT_EQ(client_of({{"Forwarded", "for=203.0.113.9;by=\"a, b\", for=198.51.100.1"}}), "198.51.100.1");
}

// Values sent by the client precede the proxy's, in the same field line or an earlier one.
TEST(Forwarding, KeepsProxyEntriesAfterForgedValues) {
  for (const char* own :
       {"1.2.3.4:\"", "[1.2.3.4]\"", "[::]\"", "\"", "1.2.3.4, \"", "[1.2.3.4", "1.2.3.4:\\\""}) {
    EXPECT_EQ(client_of({{"X-Forwarded-For", std::string(own) + ", 198.51.100.1"}}), "198.51.100.1") << own;
    EXPECT_EQ(client_of({{"X-Forwarded-For", own}, {"X-Forwarded-For", "198.51.100.1"}}), "198.51.100.1")
        << own;
  }
  for (const char* own :
       {"for=1.2.3.4;x=\"", "for=1.2.3.4;by=\"", "for=\"1.2.3.4", "\"", "for=1.2.3.4;x=\"\\\""}) {
    const std::string appended = std::string(own) + ", for=198.51.100.1";
    EXPECT_EQ(client_of({{"Forwarded", appended}}), "10.0.0.1") << own;
    EXPECT_EQ(client_of({{"Forwarded", appended}, {"X-Forwarded-For", "1.2.3.4"}}), "10.0.0.1") << own;
    EXPECT_EQ(client_of({{"Forwarded", own}, {"Forwarded", "for=198.51.100.1"}}), "198.51.100.1") << own;
  }
  EXPECT_EQ(client_of({{"Forwarded", "for=1.2.3.4;x=\"\\\"\", for=198.51.100.1"}}), "198.51.100.1");
  EXPECT_EQ(client_of({{"Forwarded", "for=1.2.3.4;by=\", for=\"[2001:db8::9]:4711\""}}), "10.0.0.1");
  EXPECT_EQ(client_of({{"Forwarded", "for=198.51.100.1;host=a;for=6.6.6.6"}}), "10.0.0.1");
  EXPECT_EQ(client_of({{"Forwarded", "for=198.51.100.1;host=a;for=6.6.6.6"}, {"X-Forwarded-For", "6.6.6.6"}}),
            "10.0.0.1");
}

TEST(Forwarding, UsesXForwardedForIfForwardedLacksClient) {
  EXPECT_EQ(client_of({{"Forwarded", "proto=https;host=x"}, {"X-Forwarded-For", "198.51.100.1"}}),
            "198.51.100.1");
}

TEST(Forwarding, StopsAtInvalidAddress) {
  for (const char* node : {"unknown", "_hidden", "198.51.100.999", "[198.51.100.1", "[198.51.100.1]x",
                           "198.51.100.1:x", "198.51.100.1:123456", "::", "0.0.0.0", "[::]:80", "[", "]",
                           "::1::", "1.2.3.4:5:6", "evil.example"}) {
    EXPECT_EQ(client_of({{"X-Forwarded-For", std::string("203.0.113.9, ") + node}}), "10.0.0.1") << node;
    EXPECT_EQ(client_of({{"X-Forwarded-For", std::string("203.0.113.9,") + node + ", 10.2.2.2"}}), "10.2.2.2")
        << node;
    EXPECT_EQ(client_of({{"Forwarded", std::string("for=") + node}}), "10.0.0.1") << node;
  }
}

// If a proxy sets only one of the two headers, the client may have forged the other.
TEST(Forwarding, IgnoresConflictingHeaders) {
  EXPECT_EQ(client_of({{"Forwarded", "for=203.0.113.9"}, {"X-Forwarded-For", "198.51.100.1"}}), "10.0.0.1");
  EXPECT_EQ(client_of({{"Forwarded", "for=198.51.100.1"}, {"X-Forwarded-For", "198.51.100.1"}}),
            "198.51.100.1");
}

TEST(Forwarding, ReturnsHostRequestedByClient) {
  const auto host = [](const Fields& headers, const char* peer = "10.0.0.1") {
    return applied(headers, peer).forwarded_host;
  };
  EXPECT_EQ(host({{"Host", "inner"}, {"X-Forwarded-Host", "render.example"}}), "render.example");
  EXPECT_EQ(host({{"Host", "inner"}, {"Forwarded", "for=1.2.3.4;host=\"render.example:8443\""}}),
            "render.example:8443");
  EXPECT_EQ(host({{"X-Forwarded-Host", "outer.example, render.example"}}), "render.example");
  EXPECT_EQ(host({{"Host", "inner"}}), "");
  EXPECT_EQ(host({{"Host", "inner"}, {"X-Forwarded-Host", "render.example"}}, "203.0.113.1"), "");
}

TEST(Forwarding, StripsPrefixFromPath) {
  const Request below = applied({}, "203.0.113.1", "/a/b", {"a", "b", "v1", "limits"});
  EXPECT_EQ(below.path, "/v1/limits");
  EXPECT_EQ(below.segments, (std::vector<std::string>{"v1", "limits"}));
  EXPECT_EQ(below.prefix, "/a/b");
  EXPECT_EQ(applied({}, "203.0.113.1", "/a/b", {"v1", "limits"}).path, "/v1/limits");
  EXPECT_EQ(applied({}, "203.0.113.1", "/a/b", {"a", "bc"}).path, "/a/bc");
  EXPECT_EQ(applied({}, "203.0.113.1", "/a/b", {"a"}).path, "/a");
  EXPECT_EQ(applied({}, "203.0.113.1", "/a/b", {"a", "b"}).path, "");
  const Request folder = applied({}, "203.0.113.1", "/a/b", {"a", "b", ""});
  EXPECT_EQ(folder.path, "/");
  EXPECT_TRUE(folder.segments.empty());
}

TEST(Forwarding, AcceptsPrefixFromTrustedProxy) {
  const auto prefix = [](const std::string& told, const char* peer = "10.0.0.1") {
    return applied({{"X-Forwarded-Prefix", told}}, peer, "/usual").prefix;
  };
  EXPECT_EQ(prefix("/render"), "/render");
  EXPECT_EQ(prefix("/render", "203.0.113.1"), "/usual");
  for (const char* bad :
       {"", "/", "//evil.example", "/a//b", "/a/", "render", "/a/../b", "/a?b", "/a b", "/%2f"})
    EXPECT_EQ(prefix(bad), "/usual") << bad;
  const Request kept = applied({{"X-Forwarded-Prefix", "/render"}}, "10.0.0.1", "/usual", {"render", "v1"});
  EXPECT_EQ(kept.path, "/v1");
  EXPECT_EQ(applied({{"X-Forwarded-Prefix", "/render"}}, "10.0.0.1", "/usual", {"usual", "v1"}).path, "/v1");
  EXPECT_EQ(prefix("/" + std::string(200, 'a')), "/usual");
}

TEST(Forwarding, RejectsInvalidPrefixes) {
  for (const char* bad : {"/", "render", "/a/", "//a", "/.", "/a/..", "/a%20b", "/a;b", "https://a"})
    EXPECT_THROW(Forwarding({}, bad), InputError) << bad;
}

}  // namespace
}  // namespace orrery
