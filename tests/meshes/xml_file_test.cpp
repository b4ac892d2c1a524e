#include "core/meshes/xml_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/errors.h"

namespace orrery::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

// Returns the error of parsing a document, or "accepted".
std::string xml_problem(const std::string& text, const XmlLimits& limits = {}) {
  return error_of([&] { XmlFile(text, "x.xml", limits); });
}

TEST(XmlFile, ReadsAttributesByLocalName) {
  const XmlFile file("<?xml version='1.0'?><!-- <a> --><n:a n:b='&lt;1' c=\" 7 \" d='-2.5e1'/>", "x.xml", {});
  EXPECT_EQ(local_name(file.root().name()), "a");
  EXPECT_EQ(XmlFile::text(file.root(), "b"), "<1");
  EXPECT_EQ(XmlFile::text(file.root(), "e"), std::nullopt);
  EXPECT_EQ(file.integer(file.root(), "c"), 7u);
  EXPECT_EQ(file.needed_number(file.root(), "d"), -25);
}

TEST(XmlFile, ReportsInvalidValuesWithTheirPlace) {
  const XmlFile file("<a><b x='4294967296' y='nan' z='1 2'/></a>", "x.xml", {});
  const pugi::xml_node b = file.root().first_child();
  EXPECT_EQ(error_of([&] { file.integer(b, "x"); }),
            "x.xml, element \"b\" at byte 4: x must be an integer from 0 to 4294967295 (got \"4294967296\")");
  EXPECT_THAT(error_of([&] { file.needed_number(b, "y"); }),
              HasSubstr("y must be a finite number (got \"nan\")"));
  EXPECT_THAT(error_of([&] { file.needed_number(b, "z"); }), HasSubstr("(got \"1 2\")"));
  EXPECT_THAT(error_of([&] { file.needed_integer(b, "w"); }), HasSubstr("must have the attribute \"w\""));
}

TEST(XmlFile, RejectsInvalidDocuments) {
  EXPECT_EQ(xml_problem("<!DOCTYPE a [<!ENTITY b 'c'>]><a/>"),
            "x.xml: must not have a document type definition");
  for (const char* text : {"", "a", "<a>", "<a></b>", "<a b=1/>", "<a b='/>", "</a>", "<", "<!-- a", "<a \""})
    EXPECT_THAT(xml_problem(text), StartsWith("x.xml: must be XML in UTF-8")) << text;
  EXPECT_THAT(xml_problem(std::string("<\0a\0/\0>\0", 8)), HasSubstr("must be XML"));
}

TEST(XmlFile, ChecksLimitsBeforeParsing) {
  const XmlLimits limits{3, 2, 2};
  EXPECT_EQ(xml_problem("<a><b/><c/></a>", limits), "accepted");
  EXPECT_EQ(xml_problem("<a><b/><c/><d/>", limits), "x.xml: must have at most 3 elements (got more)");
  EXPECT_EQ(xml_problem("<a><b/></a><c/><d/>", limits), "x.xml: must have at most 3 elements (got more)");
  EXPECT_EQ(xml_problem("<a b='' c='='/>", limits), "accepted");
  EXPECT_EQ(xml_problem("<a b='' c='' d=''>", limits), "x.xml: must have at most 2 attributes (got more)");
  EXPECT_EQ(xml_problem("<a><b></b><c></c></a>", limits), "accepted");
  EXPECT_EQ(xml_problem("<a><b><c>", limits), "x.xml: must have at most 2 levels of elements (got more)");
  std::string deep;
  for (int i = 0; i < 1'000'000; ++i) deep += "<a>";
  EXPECT_EQ(xml_problem(deep), "x.xml: must have at most 100 levels of elements (got more)");
}

}  // namespace
}  // namespace orrery::test
