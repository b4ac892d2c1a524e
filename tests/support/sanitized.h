#pragma once

namespace orrery::test {

// Built with a sanitizer: up to a hundred times slower, and freed memory is kept to find who still uses it.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace orrery::test
