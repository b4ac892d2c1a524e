#pragma once

#include <cstdlib>
#include <string_view>

namespace orrery::test {

// Whether tests run at their full size: `script/test --all` and the sanitizers do, `script/test` does not.
// tests/exhaustive.txt lists the tests that are concerned.
inline bool exhaustive() {
  const char* const set = std::getenv("TEST_EXHAUSTIVE");
  return set && std::string_view(set) == "yes";
}

}  // namespace orrery::test
