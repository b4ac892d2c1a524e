#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace orrery {

// An IP address. IPv4 addresses are stored as IPv4-mapped IPv6 addresses (RFC 4291, 2.5.5.2).
class IpAddress {
 public:
  IpAddress() = default;  // the unspecified address
  // Parses "192.0.2.1" or "2001:db8::1". Returns nullopt for any other text.
  static std::optional<IpAddress> parse(std::string_view text);
  // Returns the remote address of a socket, or the unspecified address if it is disconnected.
  static IpAddress of_peer(int fd);

  bool is_v4() const;
  // Returns the identity of a client: its IPv4 address, or the upper 64 bits of its IPv6 address. A client
  // can choose the lower 64 bits itself. Returns "" for the unspecified address.
  std::string network() const;
  const std::array<std::uint8_t, 16>& bytes() const { return bytes_; }

  bool operator==(const IpAddress&) const = default;

 private:
  std::array<std::uint8_t, 16> bytes_{};
};

// Addresses with a common prefix.
class IpNetwork {
 public:
  // Parses "10.0.0.0/8", "fd00::/8" or a single address. Throws InputError with an empty pointer for any
  // other text, and for bits set after the prefix.
  explicit IpNetwork(std::string_view text);
  bool contains(const IpAddress& address) const;

 private:
  IpAddress first_;
  int bits_ = 128;  // prefix length
};

}  // namespace orrery
