#pragma once

#include <gtest/gtest.h>

#include <cctype>
#include <string>

namespace orrery::test {

// Notes which rows of the stability catalogue the running test covers ("A1 A3"); script/test prints them all.
inline void covers(const char* rows) { testing::Test::RecordProperty("stability", rows); }

// Names the cases of a parameterised suite after the parameter itself.
inline std::string by_name(const testing::TestParamInfo<std::string>& parameter) {
  std::string name = parameter.param;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

}  // namespace orrery::test
