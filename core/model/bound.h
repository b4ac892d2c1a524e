#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string_view>

namespace orrery {

// How far something may take a picture from the one without it.
struct Bound {
  // What the numbers rest on, the strongest first: nothing changes; no picture differs by more; pixels that
  // were drawn at random tell, of any picture; samples tell.
  enum class Kind { exact, proved, audited, estimated, unknown };
  Kind kind = Kind::exact;
  // Largest and root-mean-square difference of a pixel's channel, in linear radiance; none if unknown.
  std::optional<double> max = 0, rms = 0;

  static Bound unknown() { return {Kind::unknown, std::nullopt, std::nullopt}; }
  // Unknown if either is not finite.
  static Bound proved(double max, double rms) {
    return std::isfinite(max) && std::isfinite(rms) ? Bound{Kind::proved, max, rms} : unknown();
  }
  // Of some pixels, which tell nothing of the largest difference.
  static Bound audited(double rms) { return {Kind::audited, std::nullopt, rms}; }
  // Of samples, which tell nothing of the largest difference.
  static Bound estimated(double rms) {
    return std::isfinite(rms) ? Bound{Kind::estimated, std::nullopt, rms} : unknown();
  }

  // Both together: as weak as the weaker.
  Bound operator+(const Bound& other) const {
    const auto sum = [](const std::optional<double>& a, const std::optional<double>& b) {
      return a && b ? std::optional(*a + *b) : std::nullopt;
    };
    return {std::max(kind, other.kind), sum(max, other.max), sum(rms, other.rms)};
  }
};

inline constexpr std::array<std::string_view, 5> kBoundKinds{"exact", "proved", "audited", "estimated",
                                                             "unknown"};
inline constexpr std::string_view name_of(Bound::Kind kind) {
  return kBoundKinds[static_cast<std::size_t>(kind)];
}

}  // namespace orrery
