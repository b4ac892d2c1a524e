#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <experimental/simd>
#include <limits>
#include <type_traits>

#include "core/math/registers.h"

// SIMD lanes: several numbers of one type that are processed at once. Formulas are templates over a number
// type N, which is either a scalar or lanes. This file contains the operations that differ between the two.
// The functions of core/math depend only on their arguments and are thread-safe. They throw nothing except
// std::bad_alloc.
namespace orrery {

namespace stdx = std::experimental;

template <class T>
struct LanesOf {
  using type = stdx::native_simd<T>;
};
template <>
struct LanesOf<long double> {  // for reference results: one lane
  using type = stdx::simd<long double, stdx::simd_abi::scalar>;
};

// Full SIMD register of T at this instruction level.
template <class T>
using Lanes = typename LanesOf<T>::type;

// Number of primitives per block. A single ray is tested with a whole block at once. At most 8, because
// larger nodes and leaves cost more than a wider register saves.
template <class T>
inline constexpr int kBlock = std::max(1, std::min(static_cast<int>(Lanes<T>::size()), 8));
template <class T>
struct BlockLanesOf {
  using type = stdx::simd<T, stdx::simd_abi::deduce_t<T, kBlock<T>>>;
};
template <>
struct BlockLanesOf<long double> {
  using type = Lanes<long double>;
};
template <class T>
using BlockLanes = typename BlockLanesOf<T>::type;

// Integer as wide as T, so that masks of both types are compatible.
template <class T>
using IndexOf = std::conditional_t<sizeof(T) == 4, std::int32_t, std::int64_t>;
template <class T>
using IndexLanes = stdx::rebind_simd_t<IndexOf<T>, Lanes<T>>;

// Number of lanes of Lanes<T>.
template <class T>
inline constexpr int kWidth = static_cast<int>(Lanes<T>::size());

template <class N>
struct NumberTraits {
  using Scalar = N;
  using Mask = bool;
};
template <class T, class Abi>
struct NumberTraits<stdx::simd<T, Abi>> {
  using Scalar = T;
  using Mask = stdx::simd_mask<T, Abi>;
};
// Scalar type of a number type, and the result type of its comparisons.
template <class N>
using ScalarOf = typename NumberTraits<N>::Scalar;
template <class N>
using MaskOf = typename NumberTraits<N>::Mask;

template <class N>
requires std::is_arithmetic_v<N>
[[gnu::always_inline]] inline N select(bool m, N a, N b) { return m ? a : b; }
template <class T, class Abi>
[[gnu::always_inline]] inline stdx::simd<T, Abi> select(const stdx::simd_mask<T, Abi>& m,
                                                        const std::type_identity_t<stdx::simd<T, Abi>>& a,
                                                        stdx::simd<T, Abi> b) {
  stdx::where(m, b) = a;
  return b;
}

[[gnu::always_inline]] inline bool any(bool m) { return m; }
[[gnu::always_inline]] inline bool all(bool m) { return m; }
template <class T, class Abi>
[[gnu::always_inline]] inline bool any(const stdx::simd_mask<T, Abi>& m) {
  return stdx::any_of(m);
}
template <class T, class Abi>
[[gnu::always_inline]] inline bool all(const stdx::simd_mask<T, Abi>& m) {
  return stdx::all_of(m);
}

// Converts a mask to the mask type of `To`, which has the same number of lanes.
template <class To, class T, class Abi>
[[gnu::always_inline]] inline typename To::mask_type mask_cast(const stdx::simd_mask<T, Abi>& m) {
  if constexpr (std::is_same_v<typename To::mask_type, stdx::simd_mask<T, Abi>>)
    return m;
  else
    return stdx::__proposed::static_simd_cast<typename To::mask_type>(m);
}

// Conversions between number types of equal width, and of their masks, for scalars and lanes.
template <class To, class From>
[[gnu::always_inline]] inline To convert_to(const From& x) {
  if constexpr (std::is_arithmetic_v<From>)
    return static_cast<To>(x);
  else
    return stdx::static_simd_cast<To>(x);
}

template <class N>
[[gnu::always_inline]] inline MaskOf<N> mask_cast_to(const auto& mask) {
  if constexpr (std::is_arithmetic_v<N>)
    return mask;
  else
    return mask_cast<N>(mask);
}

template <class T>
[[gnu::always_inline]] inline Lanes<T> load(const T* from) {
  return Lanes<T>(from, stdx::vector_aligned);
}

// min_first() returns the smaller number, max_first() the larger. Both return `accumulator` if the numbers
// are equal (-0 equals +0) or if either is NaN. A NaN `x` therefore never replaces the accumulator.
template <class N>
[[gnu::always_inline]] inline N min_first(const N& accumulator, const N& x) {
  if constexpr (registers::kFits<ScalarOf<N>, N>) {
    using Raw = registers::RawOf<ScalarOf<N>, N>;
    return std::bit_cast<N>(registers::min(std::bit_cast<Raw>(x), std::bit_cast<Raw>(accumulator)));
  } else {
    return select(x < accumulator, x, accumulator);
  }
}
template <class N>
[[gnu::always_inline]] inline N max_first(const N& accumulator, const N& x) {
  if constexpr (registers::kFits<ScalarOf<N>, N>) {
    using Raw = registers::RawOf<ScalarOf<N>, N>;
    return std::bit_cast<N>(registers::max(std::bit_cast<Raw>(x), std::bit_cast<Raw>(accumulator)));
  } else {
    return select(x > accumulator, x, accumulator);
  }
}

// Returns a * b - c, rounded once with FMA and twice without. Use this function only in code that requires
// FMA, or for bounds whose padding covers both results.
template <class N>
[[gnu::always_inline]] inline N multiply_subtract(const N& a, const N& b, const N& c) {
#if defined(__FMA__)
  if constexpr (registers::kFits<ScalarOf<N>, N>) {
    using Raw = registers::RawOf<ScalarOf<N>, N>;
    return std::bit_cast<N>(
        registers::fused(std::bit_cast<Raw>(a), std::bit_cast<Raw>(b), std::bit_cast<Raw>(c)));
  }
#endif
  return a * b - c;
}

}  // namespace orrery
