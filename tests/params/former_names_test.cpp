#include "core/params/former_names.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "core/base/error.h"
#include "core/params/params.h"

namespace orrery {
namespace {

double read_error(const std::string& text) {
  double error = -1;
  read_document(parse_document(text),
                [&](Params& p) { error = p.number("max_error", "", {.min = 0, .max = 1}); });
  return error;
}

std::string problem_of(const std::string& text) {
  try {
    read_error(text);
  } catch (const InputError& error) {
    return error.problems()[0].pointer + ": " + error.problems()[0].detail;
  }
  return "";
}

TEST(FormerNames, ReadsFormerKeyAsAlias) {
  EXPECT_EQ(read_error(R"({"error": 0.5})"), 0.5);
  EXPECT_EQ(read_error(R"({"max_error": 0.5})"), 0.5);
}

TEST(FormerNames, ReportsKeyAsWritten) { EXPECT_EQ(problem_of(R"({"error": 2})").substr(0, 8), "/error: "); }

TEST(FormerNames, RejectsBothNamesTogether) {
  EXPECT_NE(problem_of(R"({"error": 0.5, "max_error": 0.5})").find("unknown key \"error\""),
            std::string::npos);
}

TEST(FormerNames, AreAbsentFromSchema) {
  const std::string schema =
      describe("", "", "", [](Params& p) { p.number("max_error", "", {.min = 0, .max = 1}, 0); });
  EXPECT_EQ(schema.find("\"error\""), std::string::npos);
}

TEST(FormerNames, AreUnique) {
  std::set<std::string_view> names;
  for (const FormerName& name : kFormerNames) {
    EXPECT_TRUE(names.insert(name.present).second) << name.present;
    EXPECT_TRUE(names.insert(name.former).second) << name.former;
  }
}

}  // namespace
}  // namespace orrery
