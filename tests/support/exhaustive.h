#pragma once

#include <cstdlib>
#include <string_view>

#include "tests/support/sanitized.h"

namespace orrery::test {

// Returns whether tests run at full size: `script/test --all` and the sanitizers do, `script/test` does not.
// tests/exhaustive.txt lists the affected tests.
inline bool exhaustive() {
  const char* const set = std::getenv("TEST_EXHAUSTIVE");
  return set && std::string_view(set) == "yes";
}

// Returns whether tests use fewer pixels or rays. Sanitizers find no more in many.
inline bool reduced() { return kSanitized || !exhaustive(); }

}  // namespace orrery::test
