#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string_view>

namespace orrery {

// Bound on the error that an approximation causes in an image.
struct Bound {
  // Evidence for the numbers, strongest first. exact: no error. proved: no image has a larger error. audited:
  // measured at random pixels. estimated: computed from samples.
  enum class Kind { exact, proved, audited, estimated, unknown };
  Kind kind = Kind::exact;
  // Largest and root-mean-square error of a pixel channel, in linear radiance. nullopt if unknown.
  std::optional<double> max = 0, rms = 0;

  static Bound unknown() { return {Kind::unknown, std::nullopt, std::nullopt}; }
  // Returns a proved bound, or unknown() if either number is not finite.
  static Bound proved(double max, double rms) {
    return std::isfinite(max) && std::isfinite(rms) ? Bound{Kind::proved, max, rms} : unknown();
  }
  // Returns a bound from measured pixels. Measured pixels do not bound the largest error.
  static Bound audited(double rms) { return {Kind::audited, std::nullopt, rms}; }
  // Returns a bound from samples, or unknown() if `rms` is not finite. Samples do not bound the largest
  // error.
  static Bound estimated(double rms) {
    return std::isfinite(rms) ? Bound{Kind::estimated, std::nullopt, rms} : unknown();
  }

  // Returns a bound on the sum of both errors, with the weaker kind of evidence.
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
