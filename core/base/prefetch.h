#pragma once

#include <cstddef>

namespace orrery {

// Prefetches all cache lines of an object.
template <class X>
[[gnu::always_inline]] inline void prefetch_lines(const X& what) {
  constexpr std::size_t kLine = 64;  // bytes
  const char* const from = reinterpret_cast<const char*>(&what);
#pragma GCC unroll 16
  for (std::size_t at = 0; at < sizeof(X); at += kLine) __builtin_prefetch(from + at);
}

}  // namespace orrery
