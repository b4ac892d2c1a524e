#pragma once

#include <cstdlib>
#include <string_view>

#include "tests/support/sanitized.h"

namespace orrery::test {

// Returns true if tests run at full size, as in `script/test --all`. tests/exhaustive.txt lists the affected
// tests.
inline bool exhaustive() {
  const char* const set = std::getenv("TEST_EXHAUSTIVE");
  return set && std::string_view(set) == "yes";
}

// Returns true if tests use fewer pixels or rays. Sanitizers find no more errors with more pixels or rays.
inline bool reduced() { return kSanitized || !exhaustive(); }

}  // namespace orrery::test
