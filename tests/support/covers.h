#pragma once

#include <gtest/gtest.h>

#include <cctype>
#include <string>

namespace orrery::test {

// Records the rows of docs/stability-catalogue.md that the running test covers ("A1 A3"). script/test prints
// them.
inline void covers(const char* rows) { testing::Test::RecordProperty("stability", rows); }

// Returns the parameter as the name of a test case, with "_" for all but letters and digits.
inline std::string parameter_name(const testing::TestParamInfo<std::string>& parameter) {
  std::string name = parameter.param;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

}  // namespace orrery::test
