#include "server/http/network.h"

#include <arpa/inet.h>
#include <sys/socket.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/number.h"

namespace orrery {
namespace {

constexpr std::array<std::uint8_t, 12> kMapped{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF};  // IPv4-mapped
constexpr int kMappedBits = 96;

// Whether the first `bits` bits are equal.
bool have_same_prefix(const IpAddress& a, const IpAddress& b, int bits) {
  for (std::size_t i = 0; bits > 0; ++i, bits -= 8) {
    const int unlike = a.bytes()[i] ^ b.bytes()[i];
    if (unlike >> std::max(8 - bits, 0) != 0) return false;
  }
  return true;
}

}  // namespace

std::optional<IpAddress> IpAddress::parse(std::string_view text) {
  IpAddress address;
  if (text.find('\0') != std::string_view::npos) return std::nullopt;
  const std::string whole(text);
  if (inet_pton(AF_INET6, whole.c_str(), address.bytes_.data()) == 1) return address;
  std::copy(kMapped.begin(), kMapped.end(), address.bytes_.begin());
  if (inet_pton(AF_INET, whole.c_str(), address.bytes_.data() + kMapped.size()) == 1) return address;
  return std::nullopt;
}

IpAddress IpAddress::of_peer(int fd) {
  sockaddr_storage storage{};
  socklen_t size = sizeof storage;
  IpAddress address;
  if (getpeername(fd, reinterpret_cast<sockaddr*>(&storage), &size) != 0) return address;
  if (storage.ss_family == AF_INET6) {
    const in6_addr& v6 = reinterpret_cast<sockaddr_in6&>(storage).sin6_addr;
    std::copy(std::begin(v6.s6_addr), std::end(v6.s6_addr), address.bytes_.begin());
  } else if (storage.ss_family == AF_INET) {
    const auto* v4 = reinterpret_cast<const std::uint8_t*>(&reinterpret_cast<sockaddr_in&>(storage).sin_addr);
    std::copy(kMapped.begin(), kMapped.end(), address.bytes_.begin());
    std::copy(v4, v4 + 4, address.bytes_.begin() + kMapped.size());
  }
  return address;
}

bool IpAddress::is_v4() const { return std::equal(kMapped.begin(), kMapped.end(), bytes_.begin()); }

std::string IpAddress::network() const {
  if (*this == IpAddress()) return "";
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (is_v4()) {
    inet_ntop(AF_INET, bytes_.data() + kMapped.size(), text.data(), text.size());
  } else {
    auto half = bytes_;
    std::fill(half.begin() + half.size() / 2, half.end(), std::uint8_t{0});
    inet_ntop(AF_INET6, half.data(), text.data(), text.size());
  }
  return text.data();
}

IpNetwork::IpNetwork(std::string_view text) {
  const std::size_t slash = text.find('/');
  const auto first = IpAddress::parse(text.substr(0, slash));
  const bool v4 = first && text.find(':') == std::string_view::npos;
  const int most = v4 ? 32 : 128;
  const auto bits = slash == std::string_view::npos ? most : parse_number<int>(text.substr(slash + 1));
  if (!first || !bits || *bits < 0 || *bits > most)
    throw InputError("", "must be an IP address or a network such as 10.0.0.0/8 (got " +
                             std::string(text.substr(0, 80)) + ")");
  first_ = *first;
  bits_ = v4 ? kMappedBits + *bits : *bits;
  for (int bit = bits_; bit < 128; ++bit)
    if (first_.bytes()[static_cast<std::size_t>(bit) / 8] >> (7 - bit % 8) & 1)
      throw InputError("", "must be a network whose bits after the first " + std::to_string(*bits) +
                               " are 0 (got " + std::string(text) + ")");
}

bool IpNetwork::contains(const IpAddress& address) const { return have_same_prefix(first_, address, bits_); }

}  // namespace orrery
