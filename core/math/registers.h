#pragma once

#include <bit>
#include <cstddef>
#include <type_traits>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

// Instructions that std::experimental::simd does not expose, for one register of float or double.
namespace orrery::registers {

template <class T, std::size_t kBytes>
struct Raw {
  using type = void;
};

#define ORRERY_REGISTER(number, bytes, raw, prefix, suffix)                                   \
  template <>                                                                                 \
  struct Raw<number, bytes> {                                                                 \
    using type = raw;                                                                         \
  };                                                                                          \
  [[gnu::always_inline]] inline raw min(raw a, raw b) { return prefix##_min_##suffix(a, b); } \
  [[gnu::always_inline]] inline raw max(raw a, raw b) { return prefix##_max_##suffix(a, b); }
#define ORRERY_FUSED(raw, prefix, suffix) \
  [[gnu::always_inline]] inline raw fused(raw a, raw b, raw c) { return prefix##_fmsub_##suffix(a, b, c); }

#if defined(__SSE2__)
ORRERY_REGISTER(float, 16, __m128, _mm, ps)
ORRERY_REGISTER(double, 16, __m128d, _mm, pd)
#endif
#if defined(__AVX__)
ORRERY_REGISTER(float, 32, __m256, _mm256, ps)
ORRERY_REGISTER(double, 32, __m256d, _mm256, pd)
#endif
#if defined(__AVX512F__)
ORRERY_REGISTER(float, 64, __m512, _mm512, ps)
ORRERY_REGISTER(double, 64, __m512d, _mm512, pd)
#endif
#if defined(__FMA__)
ORRERY_FUSED(__m128, _mm, ps)
ORRERY_FUSED(__m128d, _mm, pd)
ORRERY_FUSED(__m256, _mm256, ps)
ORRERY_FUSED(__m256d, _mm256, pd)
#endif
#if defined(__AVX512F__)
ORRERY_FUSED(__m512, _mm512, ps)
ORRERY_FUSED(__m512d, _mm512, pd)
#endif

#undef ORRERY_REGISTER
#undef ORRERY_FUSED

// Intrinsic vector type with the bits of V if V is one register of T, otherwise void.
template <class T, class V>
using RawOf = typename Raw<T, sizeof(V)>::type;
template <class T, class V>
inline constexpr bool kFits = !std::is_void_v<RawOf<T, V>>;

}  // namespace orrery::registers
