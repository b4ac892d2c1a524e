#pragma once

#include <cmath>
#include <numbers>

// Sine, cosine and tangent of an angle in degrees, in double precision. Only IEEE operations are used, so
// every machine returns the same bits. Results are exactly periodic, and exact at multiples of 90 degrees.
namespace orrery {

struct SineCosine {
  double sine, cosine;
};

namespace detail {
// Taylor series about 0 for |x| <= pi/4.
inline double small_sine(double x) {
  const double x2 = x * x;
  double series = 1.0;
  for (int k = 10; k >= 1; --k) series = 1.0 - series * x2 / ((2.0 * k) * (2.0 * k + 1.0));
  return x * series;
}
inline double small_cosine(double x) {
  const double x2 = x * x;
  double series = 1.0;
  for (int k = 10; k >= 1; --k) series = 1.0 - series * x2 / ((2.0 * k - 1.0) * (2.0 * k));
  return series;
}
}  // namespace detail

inline SineCosine sine_cosine_degrees(double degrees) {
  if (!std::isfinite(degrees)) return {degrees - degrees, degrees - degrees};
  const double turn = std::remainder(degrees, 360.0);  // exact
  const double quarter = std::nearbyint(turn / 90.0);
  const double x = (turn - quarter * 90.0) * (std::numbers::pi / 180.0);
  const double s = detail::small_sine(x), c = detail::small_cosine(x);
  switch ((static_cast<int>(quarter) + 4) % 4) {
    case 0: return {s, c};
    case 1: return {c, -s};
    case 2: return {-s, -c};
    default: return {-c, s};
  }
}

inline double tangent_degrees(double degrees) {
  const SineCosine a = sine_cosine_degrees(degrees);
  return a.sine / a.cosine;
}

}  // namespace orrery
