#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace orrery {

// An IP address. IPv4 is held as IPv6 that maps it (RFC 4291, 2.5.5.2).
class IpAddress {
 public:
  IpAddress() = default;  // the unspecified one, of nobody
  // "192.0.2.1" or "2001:db8::1"; none for any other text.
  static std::optional<IpAddress> parse(std::string_view text);
  // Of the other end of a socket; unspecified if it has gone.
  static IpAddress of_peer(int fd);

  bool is_v4() const;
  // What one client is known by: its IPv4 address, or the half of its IPv6 address that it does not choose
  // itself; "" for the unspecified one.
  std::string network() const;
  const std::array<std::uint8_t, 16>& bytes() const { return bytes_; }

  bool operator==(const IpAddress&) const = default;

 private:
  std::array<std::uint8_t, 16> bytes_{};
};

// The addresses that begin with the same bits.
class IpNetwork {
 public:
  // "10.0.0.0/8", "fd00::/8", or one address. Throws InputError without a place for any other text, and for
  // bits after the network's.
  explicit IpNetwork(std::string_view text);
  bool contains(const IpAddress& address) const;

 private:
  IpAddress first_;
  int bits_ = 128;  // of first_ that all have
};

}  // namespace orrery
