#pragma once

#include <concepts>
#include <cstdint>

#include "core/math/lanes.h"

// Sample positions made of integers alone, from (seed, pixel, sample, dimension): no state, the same for any
// order of evaluation. Bits are 32, in one number or in each lane of several.
namespace orrery {

template <class N>
concept Bits32 = std::same_as<ScalarOf<N>, std::uint32_t>;

// A bijective mix of 32 bits (Wellons' search for low bias: shifts 16, 15, 16).
template <Bits32 Bits>
[[gnu::always_inline]] inline Bits mix_bits(Bits x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}

template <Bits32 Bits>
[[gnu::always_inline]] inline Bits combine_bits(std::uint32_t a, Bits b) {
  return mix_bits<Bits>(a ^ (b * 0x9e3779b9u + 0x7f4a7c15u));
}

template <Bits32 Bits>
[[gnu::always_inline]] inline Bits reverse_bits(Bits x) {
  x = x << 16 | x >> 16;
  x = (x & 0x00ff00ffu) << 8 | ((x >> 8) & 0x00ff00ffu);
  x = (x & 0x0f0f0f0fu) << 4 | ((x >> 4) & 0x0f0f0f0fu);
  x = (x & 0x33333333u) << 2 | ((x >> 2) & 0x33333333u);
  return (x & 0x55555555u) << 1 | ((x >> 1) & 0x55555555u);
}

// Owen's nested uniform scrambling by hashing (Burley, "Practical Hash-based Owen Scrambling", JCGT 2020,
// after Laine and Karras), of numbers whose bits are reversed: every bit is flipped by a hash of the lower
// ones.
template <Bits32 Bits>
[[gnu::always_inline]] inline Bits scramble_reversed(std::uint32_t reversed, const Bits& seed) {
  Bits x = reversed + seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  x ^= x * 0x8d22f6e6u;
  return x;
}

// Second dimension of Sobol's sequence; the first is reverse_bits. Together every aligned block of 2^m
// indices puts one point into each elementary interval of area 2^-m.
inline std::uint32_t sobol_second(std::uint32_t index) {
  std::uint32_t result = 0;
  for (std::uint32_t direction = 1u << 31; index != 0; index >>= 1, direction ^= direction >> 1)
    if (index & 1u) result ^= direction;
  return result;
}

// Top 24 bits as a float in [0, 1): never rounds up to 1.
inline float unit_float(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }
template <Bits32 Bits>
requires(!std::same_as<Bits, std::uint32_t>) [[gnu::always_inline]] inline auto unit_float(const Bits& bits) {
  using Signed = stdx::rebind_simd_t<std::int32_t, Bits>;  // what machines convert
  using Floats = stdx::rebind_simd_t<float, Bits>;
  return stdx::static_simd_cast<Floats>(stdx::static_simd_cast<Signed>(bits >> 8)) * 0x1p-24f;
}

template <class Unit>
struct SamplePoint {
  Unit u, v;  // in [0, 1)
};

// Point `sample` of the scrambled sequence that belongs to `stream` (a hash of seed, pixel and purpose).
template <Bits32 Bits>
[[gnu::always_inline]] inline auto stratified_point(std::uint32_t sample, const Bits& stream) {
  const std::uint32_t second = reverse_bits(sobol_second(sample));
  const Bits u = reverse_bits(scramble_reversed(sample, stream)),
             v = reverse_bits(scramble_reversed(second, mix_bits<Bits>(stream + 0x68bc21ebu)));
  return SamplePoint<decltype(unit_float(u))>{unit_float(u), unit_float(v)};
}

}  // namespace orrery
