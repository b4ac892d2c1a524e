#pragma once

#include <cstdlib>
#include <string_view>

#include "tests/support/sanitized.h"

namespace orrery::test {

// Whether tests run at their full size: `script/test --all` and the sanitizers do, `script/test` does not.
// tests/exhaustive.txt lists the tests that are concerned.
inline bool exhaustive() {
  const char* const set = std::getenv("TEST_EXHAUSTIVE");
  return set && std::string_view(set) == "yes";
}

// Whether a test of pixels or rays takes fewer of them: sanitizers see no more in many.
inline bool reduced() { return kSanitized || !exhaustive(); }

}  // namespace orrery::test
