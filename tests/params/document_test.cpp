#include "core/params/document.h"

#include <gtest/gtest.h>

#include <string>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/params/json.h"

namespace orrery {
namespace {

std::string canonical(std::string_view text) { return parse_document(text).canonical(); }

InputError input_error(std::string_view text, const JsonLimits& limits = {}) {
  try {
    parse_document(text, limits);
  } catch (const InputError& error) {
    return error;
  }
  ADD_FAILURE() << "accepted: " << text.substr(0, 80);
  return InputError("", "none");
}

MalformedJson malformed(std::string_view text) {
  try {
    parse_document(text);
  } catch (const MalformedJson& error) {
    return error;
  } catch (const InputError& error) {
    ADD_FAILURE() << "not malformed but: " << error.what();
  }
  ADD_FAILURE() << "accepted: " << text.substr(0, 80);
  return MalformedJson("", "none", 0, 0, 0);
}

std::string nested(std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); }

TEST(Hash, MatchesPublishedVectors) {
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Canonical, SortsKeysAndDropsLayout) {
  EXPECT_EQ(canonical(" { \"b\" : [ 1 , true , null ] ,\n \"a\" : { } , \"c\": [] } "),
            R"({"a":{},"b":[1,true,null],"c":[]})");
}

TEST(Canonical, WritesEqualNumbersEqually) {
  EXPECT_EQ(canonical("[1, 1.0, 10e-1, -0.0, 0, -0, 0.1, 1e300, 123456.5, 1e15, 1e-7]"),
            "[1,1,1,0,0,0,0.1,1e+300,123456.5,1000000000000000,1e-07]");
}

TEST(Canonical, RoundTripsDoubles) {
  for (const char* text :
       {"0.1", "2.2250738585072014e-308", "1.7976931348623157e308", "5e-324", "-3.3333333333333335",
        "9007199254740993", "18446744073709551615", "0.30000000000000004"}) {
    const Document first = parse_document(text);
    const Document again = parse_document(first.canonical());
    EXPECT_EQ(json_of(first).get<double>(), json_of(again).get<double>()) << text;
    EXPECT_EQ(first.canonical(), again.canonical()) << text;
  }
}

TEST(Canonical, WritesUnescapedUtf8AndMinimalEscapes) {
  EXPECT_EQ(canonical(R"(["\u00e9\"\\\n\t\u0001\/\u0000 é"])"), R"(["é\"\\\n\t\u0001/\u0000 é"])");
}

TEST(Canonical, GivesEqualIdForAllLayouts) {
  const Document a = parse_document(R"({"x": 1.0, "y": [2]})");
  const Document b = parse_document("{\"y\":[2.000],\r\n\"x\":1}");
  const Document c = parse_document(R"({"x": 1.0, "y": [3]})");
  EXPECT_EQ(a.id(), b.id());
  EXPECT_NE(a.id(), c.id());
  EXPECT_EQ(a.id(), sha256_hex(R"({"x":1,"y":[2]})"));
}

TEST(Document, KeepsTreeAliveThroughMember) {
  std::optional<Document> scene;
  {
    const Document whole = parse_document(R"({"a/b~": {"version": 1}, "list": [1]})");
    EXPECT_TRUE(whole.has("list"));
    EXPECT_FALSE(whole.has("scene"));
    EXPECT_FALSE(whole.member("scene"));
    EXPECT_FALSE(whole.member("list")->member("x"));
    scene = whole.member("a/b~");
  }
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->canonical(), R"({"version":1})");
  EXPECT_EQ(scene->pointer(), "/a~1b~0");
}

TEST(JsonParser, ReportsErrorOffsetLineAndColumn) {
  const MalformedJson error = malformed("{\n  \"é\": 1,\n  \"é\" 2\n}");
  EXPECT_EQ(error.offset(), 20u);
  EXPECT_EQ(error.line(), 3u);
  EXPECT_EQ(error.column(), 7u);
  EXPECT_STREQ(error.what(), "/é: line 3, column 7: must be ':' (got a number)");
}

TEST(JsonParser, ReportsPointerOfError) {
  const MalformedJson error = malformed(R"({"objects": [{"radius": 1}, {"radius": NaN}]})");
  EXPECT_EQ(error.problems().front().pointer, "/objects/1/radius");
  EXPECT_EQ(error.problems().front().detail, "line 1, column 40: \"NaN\" is not a JSON value");
}

TEST(JsonParser, ReportsInvalidLiterals) {
  for (const char* word :
       {"NaN", "Infinity", "-Infinity", "nan", "+1", "01", ".5", "1.", "0x10", "tru", "None"}) {
    const std::string text = "[1, " + std::string(word) + "]";
    const MalformedJson error = malformed(text);
    EXPECT_EQ(error.line(), 1u) << text;
    EXPECT_GE(error.offset(), 4u) << text;
    EXPECT_LE(error.offset(), text.size() - 1) << text;
  }
  EXPECT_NE(std::string(malformed("[-Infinity]").what()).find("\"-Infinity\" is not a JSON value"),
            std::string::npos);
}

TEST(JsonParser, RejectsTruncatedAndTrailingText) {
  EXPECT_EQ(malformed("").offset(), 0u);
  EXPECT_EQ(malformed("{\"a\": [1, 2").offset(), 11u);
  EXPECT_EQ(malformed("{} {}").offset(), 3u);
  EXPECT_EQ(malformed("[1,]").offset(), 3u);
  EXPECT_EQ(malformed("{\"a\":1,}").offset(), 7u);
  EXPECT_EQ(malformed(R"({"a": 1 "\\\"b" : 2})").offset(), 8u);
  EXPECT_EQ(malformed("[1 true]").offset(), 3u);
  malformed("\"open");
}

TEST(JsonParser, ReportsMissingCommasAndBrackets) {
  const auto detail_of = [](const char* text) { return malformed(text).problems().front().detail; };
  EXPECT_EQ(detail_of("{\n  \"a\": 1\n  \"b\": 2\n}"),
            "line 3, column 3: a comma or '}' is missing before text in double quotes");
  EXPECT_EQ(detail_of("[1 2]"), "line 1, column 4: a comma or ']' is missing before a number");
  EXPECT_EQ(detail_of("[{} {}]"), "line 1, column 5: a comma or ']' is missing before '{'");
  EXPECT_EQ(detail_of("{\"a\": [1, 2}"), "line 1, column 12: a comma or ']' is missing before '}'");
  EXPECT_EQ(detail_of("{\"a\": [1, 2"), "line 1, column 12: ']' is missing at the end of the text");
  EXPECT_EQ(detail_of("{\"a\": 1"), "line 1, column 8: '}' is missing at the end of the text");
  EXPECT_EQ(detail_of("{\"a\" 1}"), "line 1, column 6: must be ':' (got a number)");
}

TEST(JsonParser, RejectsCommentsZeroBytesAndInvalidText) {
  malformed("// scene\n{}");
  malformed("{} /* end */");
  malformed("{'a': 1}");
  EXPECT_EQ(malformed(std::string_view("{}\0{}", 5)).offset(), 2u);
  for (const char* bytes :
       {"\"\xff\"", "\"\xc3\"", "\"\xed\xa0\x80\"", "\"\xc0\xaf\"", "\"\\ud800\"", "\"a\nb\""})
    malformed(bytes);
}

TEST(JsonParser, WritesShortReadableMessages) {
  const std::string junk = "{\"" + std::string(100000, 'x') + "\xff\": 1}";
  for (const std::string& text :
       {std::string("{\"a\" 1}"), std::string("nope"), junk, std::string("[1, 2")}) {
    const std::string what = malformed(text).what();
    EXPECT_EQ(what.find("json.exception"), std::string::npos) << what;
    EXPECT_LT(what.size(), 200u);
    EXPECT_EQ(what.find('\xff'), std::string::npos);
  }
}

TEST(JsonParser, ReportsEveryDuplicateKey) {
  const InputError error =
      input_error(R"({"a": 1, "b": {"x": 1, "x": 2}, "c": [0, {"y": 1, "y": [1]}], "a": 2})");
  ASSERT_EQ(error.problems().size(), 3u);
  EXPECT_EQ(error.problems()[0].pointer, "/b/x");
  EXPECT_EQ(error.problems()[0].detail, "duplicate key \"x\"");
  EXPECT_EQ(error.problems()[1].pointer, "/c/1/y");
  EXPECT_EQ(error.problems()[2].pointer, "/a");
}

TEST(JsonParser, ReportsAtMostTwentyDuplicates) {
  std::string text = "{\"a\":0";
  for (int i = 0; i < 1000; ++i) text += ",\"a\":0";
  EXPECT_EQ(input_error(text + "}").problems().size(), InputError::kMaxProblems);
}

TEST(JsonParser, RejectsNumbersBeyondDoubleRange) {
  for (const char* number : {"1e999", "-1e999", "1e400"}) {
    const InputError error =
        input_error(R"({"lights": [{}, {"intensity": [1, )" + std::string(number) + "]}]}");
    EXPECT_EQ(error.problems().front().pointer, "/lights/1/intensity/1");
    EXPECT_EQ(error.problems().front().detail,
              "must be within the range of a double (got \"" + std::string(number) + "\")");
  }
  EXPECT_EQ(canonical("1e-999"), "0");
}

TEST(JsonLimits, RejectsDepthAboveLimit) {
  EXPECT_NO_THROW(parse_document(nested(32)));
  const InputError error = input_error(nested(33));
  EXPECT_EQ(error.problems().front().detail, "JSON is nested too deeply (limit 32 levels, json_depth)");
  input_error(nested(1'000'000));  // neither recursion nor time grows with the depth
  EXPECT_NO_THROW(parse_document(nested(5), {.depth = 5}));
  input_error(nested(6), {.depth = 5});
}

TEST(JsonLimits, RejectsNodesAboveLimit) {
  EXPECT_NO_THROW(parse_document(R"({"a": [1, 2], "b": 3})", {.nodes = 5}));
  const InputError error = input_error(R"({"a": [1, 2], "b": 3})", {.nodes = 4});
  EXPECT_EQ(error.problems().front().pointer, "/b");
  EXPECT_EQ(error.problems().front().detail, "document has more than 4 JSON values (limit 4, json_nodes)");
}

TEST(InputError, SummarizesFirstProblemAndCountsOthers) {
  EXPECT_STREQ(InputError(std::vector<Problem>{{"/a", "bad"}, {"/b", "worse"}, {"", "worst"}}).what(),
               "/a: bad (and 2 more problems)");
  EXPECT_STREQ(InputError(std::vector<Problem>{{"", "bad"}, {"/b", "worse"}}).what(),
               "bad (and 1 more problem)");
  EXPECT_EQ(InputError(std::vector<Problem>(50, Problem{"/a", "bad"})).problems().size(), 20u);
  EXPECT_EQ(Busy("queue full", 2.5).retry_after_s(), 2.5);
}

}  // namespace
}  // namespace orrery
