#pragma once

#include "core/math/lanes.h"

// Elementary functions of scalars and lanes. Only IEEE operations are used, so every machine and vector width
// returns the same bits. libm may differ between machines, because it selects variants by processor. The
// logarithm uses the atanh series (|s| <= 0.172), 2^f the Taylor series (|f| <= 1/2). Both series have enough
// terms for a truncation error below half an ulp of the type.
namespace orrery {

namespace detail {

template <class T>
struct FloatFormat;
template <>
struct FloatFormat<float> {
  static constexpr int kMantissaBits = 23;
  static constexpr std::int32_t kSqrtHalfBits = 0x3f3504f3;  // bits of sqrt(1/2)
  static constexpr std::int32_t kMantissaMask = 0x007fffff;
  static constexpr std::int32_t kExponentBias = 127;
  static constexpr int kLogTerms = 5, kExpTerms = 7;
};
template <>
struct FloatFormat<double> {
  static constexpr int kMantissaBits = 52;
  static constexpr std::int64_t kSqrtHalfBits = 0x3fe6a09e667f3bcd;
  static constexpr std::int64_t kMantissaMask = 0x000fffffffffffff;
  static constexpr std::int64_t kExponentBias = 1023;
  static constexpr int kLogTerms = 12, kExpTerms = 14;
};

template <class N>
struct IntegerOf {
  using type = IndexOf<N>;
};
template <class T, class Abi>
struct IntegerOf<stdx::simd<T, Abi>> {
  using type = stdx::rebind_simd_t<IndexOf<T>, stdx::simd<T, Abi>>;
};

}  // namespace detail

// Returns log2(x). REQUIRES: x is positive and normal. The result for other arguments is an arbitrary finite
// number.
template <class N>
[[gnu::always_inline]] inline N log2_normal(const N& x) {
  using T = ScalarOf<N>;
  using Format = detail::FloatFormat<T>;
  using Integer = typename detail::IntegerOf<N>::type;
  const Integer bits = std::bit_cast<Integer>(x) - Integer(Format::kSqrtHalfBits);
  const Integer exponent = bits >> Format::kMantissaBits;
  const N m = std::bit_cast<N>((bits & Integer(Format::kMantissaMask)) + Integer(Format::kSqrtHalfBits));
  const N s = (m - T(1)) / (m + T(1));
  const N s2 = s * s;
  N series = N(T(1) / T(2 * Format::kLogTerms - 1));
#pragma GCC unroll 16
  for (int k = Format::kLogTerms - 2; k >= 0; --k) series = series * s2 + T(1) / T(2 * k + 1);
  constexpr T kTwoOverLn2 = T(2.88539008177792681471984936200378427L);
  return convert_to<N>(exponent) + s * series * kTwoOverLn2;
}

// Returns 2^y, or 0 if y is below the smallest normal exponent. REQUIRES: y is at most the largest exponent,
// 127 for float and 1023 for double.
template <class N>
[[gnu::always_inline]] inline N exp2_flushed(const N& y) {
  using T = ScalarOf<N>;
  using Format = detail::FloatFormat<T>;
  using Integer = typename detail::IntegerOf<N>::type;
  constexpr T kLowest = T(1 - Format::kExponentBias);
  const N clamped = select(y > N(kLowest), y, N(kLowest));
  // Adding and subtracting 1.5 * 2^mantissa rounds to the nearest integer.
  constexpr T kRounder = T(3) * T(std::int64_t{1} << (Format::kMantissaBits - 1));
  const N whole = (clamped + kRounder) - kRounder;
  constexpr T kLn2 = T(0.693147180559945309417232121458176568L);
  const N z = (clamped - whole) * kLn2;
  N series = N(T(1));
#pragma GCC unroll 16
  for (int k = Format::kExpTerms; k >= 1; --k) series = series * z * (T(1) / T(k)) + T(1);
  const Integer scale = (convert_to<Integer>(whole) + Integer(Format::kExponentBias))
                        << Format::kMantissaBits;
  return select(y < N(kLowest), N(T(0)), series * std::bit_cast<N>(scale));
}

// Returns x^y for x in [0, 1] and y >= 0, with 0^0 = 1. Flushes results below the smallest normal number to
// 0. The relative error is at most 2 y |log2 x| ulp, plus 3 ulp, and at most 2.5e-5 (float) or 4e-13
// (double).
template <class N>
[[gnu::always_inline]] inline N pow_unit(const N& x, const N& y) {
  using T = ScalarOf<N>;
  constexpr T kSmallest = std::numeric_limits<T>::min();
  const auto vanishing = x < N(kSmallest);
  const N power = exp2_flushed(y * log2_normal(select(vanishing, N(T(1)), x)));
  return select(vanishing, select(y > N(T(0)), N(T(0)), N(T(1))), power);
}

// Sine and cosine of an angle in turns. The absolute error is at most 2 epsilon, and 0 at quarter turns.
// REQUIRES: |turns| <= 2^20.
template <class N>
struct SineCosineOf {
  N sine, cosine;
};
template <class N>
[[gnu::always_inline]] inline SineCosineOf<N> sine_cosine_turns(const N& turns) {
  using T = ScalarOf<N>;
  using Integer = typename detail::IntegerOf<N>::type;
  constexpr int kTerms = sizeof(T) == 4 ? 5 : 10;
  constexpr T kRounder = T(3) * T(std::int64_t{1} << (detail::FloatFormat<T>::kMantissaBits - 1));
  const N quarter = (turns * T(4) + kRounder) - kRounder;
  const N x = (turns - quarter * T(0.25)) * T(6.28318530717958647692528676655900577L);
  const N x2 = x * x;
  N sine(T(1)), cosine(T(1));
#pragma GCC unroll 16
  for (int k = kTerms; k >= 1; --k) {
    sine = T(1) - sine * x2 * (T(1) / (T(2 * k) * T(2 * k + 1)));
    cosine = T(1) - cosine * x2 * (T(1) / (T(2 * k - 1) * T(2 * k)));
  }
  sine = x * sine;
  const Integer q = convert_to<Integer>(quarter) & Integer(3);
  const auto swapped = mask_cast_to<N>((q & Integer(1)) != Integer(0));
  const auto sine_negative = mask_cast_to<N>((q & Integer(2)) != Integer(0));
  const auto cosine_negative = mask_cast_to<N>(((q + Integer(1)) & Integer(2)) != Integer(0));
  const N s = select(swapped, cosine, sine), c = select(swapped, sine, cosine);
  return {select(sine_negative, N(-s), s), select(cosine_negative, N(-c), c)};
}

// Returns the angle of the direction (x, y) from the x axis toward the y axis, in turns in [-1/2, 1/2].
// Returns 0 for (0, 0). Halves the angle three times by atan t = 2 atan(t / (1 + sqrt(1 + t^2))), then uses
// the Taylor series.
template <class N>
[[gnu::always_inline]] inline N direction_turns(const N& x, const N& y) {
  using T = ScalarOf<N>;
  using std::abs;
  using std::sqrt;
  const N zero(T(0)), ax = abs(x), ay = abs(y);
  const auto steep = ay > ax;
  const N larger = select(steep, ay, ax), smaller = select(steep, ax, ay);
  N t = select(larger > zero, N(smaller / larger), zero);
#pragma GCC unroll 3
  for (int halving = 0; halving < 3; ++halving) t = t / (T(1) + sqrt(T(1) + t * t));
  constexpr int kTerms = sizeof(T) == 4 ? 4 : sizeof(T) == 8 ? 9 : 11;
  const N t2 = t * t;
  N series(T(1) / T(2 * kTerms + 1));
#pragma GCC unroll 16
  for (int k = kTerms - 1; k >= 0; --k) series = T(1) / T(2 * k + 1) - series * t2;
  constexpr T kTurnsPerRadian = T(0.159154943091895335768883763372514362L);
  N turns = T(8) * t * series * kTurnsPerRadian;
  turns = select(steep, N(T(0.25) - turns), turns);
  turns = select(x < zero, N(T(0.5) - turns), turns);
  return select(y < zero, N(-turns), turns);
}

// Returns the angle of direction_turns() in [0, 1]: negative angles are increased by one turn.
template <class N>
[[gnu::always_inline]] inline N positive_turns(const N& x, const N& y) {
  using T = ScalarOf<N>;
  const N turns = direction_turns(x, y);
  return select(turns < N(T(0)), N(turns + T(1)), turns);
}

}  // namespace orrery
