#pragma once

namespace orrery::test {

// True in builds with a sanitizer. Sanitizers make programs up to a hundred times slower, and keep freed
// memory to detect later uses.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace orrery::test
