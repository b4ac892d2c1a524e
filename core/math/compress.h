#pragma once

#include "core/math/lanes.h"

#if defined(__AVX512F__) || defined(__BMI2__)
#include <immintrin.h>
#endif

namespace orrery {

// Returns the lanes of a mask as bits. Lane 0 is the lowest bit.
template <class T, class Abi>
[[gnu::always_inline]] inline unsigned bits_of(const stdx::simd_mask<T, Abi>& m) {
  if constexpr (stdx::simd_mask<T, Abi>::size() == 1) {
    return m[0];
  } else {
    auto bits = static_cast<unsigned>(m.__to_bitset().to_ulong());
#if defined(ORRERY_SANITIZED) && defined(__AVX512F__)
    // With ThreadSanitizer, GCC 12 stores 8 or 16 bits of a mask register on the stack and reads 32 bits
    // back. The empty asm forces the bits into a general register, which zero-extends them.
    asm("" : "+r"(bits));
#endif
    return bits;
  }
}

// Stores the lanes selected by `bits` in consecutive elements of `to`, in lane order. REQUIRES: `to` has
// space for all lanes of `v`, because the elements after the selected ones may be overwritten.
template <class V, class T>
[[gnu::always_inline]] inline void compress_store(const V& v, unsigned bits, T* to) {
#if defined(__AVX512F__)
  if constexpr (sizeof(V) == 64 && sizeof(T) == 4) {
    const auto packed = _mm512_maskz_compress_epi32(static_cast<__mmask16>(bits), std::bit_cast<__m512i>(v));
    _mm512_storeu_si512(to, packed);
    return;
  } else if constexpr (sizeof(V) == 64 && sizeof(T) == 8) {
    const auto packed = _mm512_maskz_compress_epi64(static_cast<__mmask8>(bits), std::bit_cast<__m512i>(v));
    _mm512_storeu_si512(to, packed);
    return;
  }
#elif defined(__AVX2__) && defined(__BMI2__)
  if constexpr (sizeof(V) == 32 && sizeof(T) == 4) {
    const std::uint64_t bytes = _pdep_u64(bits, 0x0101010101010101u) * 0xff;
    const std::uint64_t chosen = _pext_u64(0x0706050403020100u, bytes);
    const __m256i order = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(chosen)));
    const __m256i packed = _mm256_permutevar8x32_epi32(std::bit_cast<__m256i>(v), order);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), packed);
    return;
  }
#endif
  for (std::size_t i = 0, n = 0; i < V::size(); ++i) {
    to[n] = v[i];
    n += (bits >> i) & 1u;
  }
}

}  // namespace orrery
