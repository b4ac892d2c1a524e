#pragma once

#include <cstdint>

// Sample positions made of integers alone, from (seed, pixel, sample, dimension): no state, the same for any
// order of evaluation.
namespace orrery {

// A bijective mix of 32 bits (Wellons' search for low bias: shifts 16, 15, 16).
inline std::uint32_t mix_bits(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}

inline std::uint32_t combine_bits(std::uint32_t a, std::uint32_t b) {
  return mix_bits(a ^ (b * 0x9e3779b9u + 0x7f4a7c15u));
}

inline std::uint32_t reverse_bits(std::uint32_t x) {
  x = __builtin_bswap32(x);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

// Owen's nested uniform scrambling by hashing (Burley, "Practical Hash-based Owen Scrambling", JCGT 2020,
// after Laine and Karras): every bit is flipped by a hash of the higher ones.
inline std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
  x = reverse_bits(x);
  x += seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  x ^= x * 0x8d22f6e6u;
  return reverse_bits(x);
}

// Second dimension of Sobol's sequence; the first is reverse_bits. Together every aligned block of 2^m
// indices puts one point into each elementary interval of area 2^-m.
inline std::uint32_t sobol_second(std::uint32_t index) {
  std::uint32_t result = 0;
  for (std::uint32_t direction = 1u << 31; index != 0; index >>= 1, direction ^= direction >> 1)
    if (index & 1u) result ^= direction;
  return result;
}

struct SamplePoint {
  float u, v;  // in [0, 1)
};

// Top 24 bits as a float in [0, 1): never rounds up to 1.
inline float unit_float(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

// Point `sample` of the scrambled sequence that belongs to `stream` (a hash of seed, pixel and purpose).
inline SamplePoint stratified_point(std::uint32_t sample, std::uint32_t stream) {
  return {unit_float(owen_scramble(reverse_bits(sample), stream)),
          unit_float(owen_scramble(sobol_second(sample), mix_bits(stream + 0x68bc21ebu)))};
}

}  // namespace orrery
