#include "server/http/head.h"

#include <gtest/gtest.h>

#include "server/http/target.h"

namespace orrery {
namespace {

TEST(Head, ParsesRequest) {
  const Head head =
      parse_head("POST /v1/render?a=b HTTP/1.1\r\nHost: here\r\ncontent-length: 12\r\nX-A: \t b c \r\n\r\n");
  EXPECT_EQ(head.method, "POST");
  EXPECT_EQ(head.target, "/v1/render?a=b");
  EXPECT_EQ(head.content_length, 12u);
  EXPECT_EQ(head.header("x-a"), "b c");
  EXPECT_TRUE(head.keep_alive);
  EXPECT_FALSE(head.chunked);
}

TEST(Head, DerivesKeepAliveFromVersion) {
  EXPECT_FALSE(parse_head("GET / HTTP/1.0\r\n\r\n").keep_alive);
  EXPECT_TRUE(parse_head("GET / HTTP/1.0\r\nConnection: Keep-Alive\r\n\r\n").keep_alive);
  EXPECT_FALSE(parse_head("GET / HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n").keep_alive);
  EXPECT_FALSE(parse_head("GET / HTTP/1.1\r\nHost: x\r\nConnection: a, Close ,b\r\n\r\n").keep_alive);
  EXPECT_TRUE(parse_head("GET / HTTP/1.1\r\nHost: x\r\nConnection: closed\r\n\r\n").keep_alive);
}

TEST(Head, DoesNotDecodeValues) {
  EXPECT_EQ(parse_head("GET / HTTP/1.1\r\nHost: x\r\nA: %0d%0aB: c\r\n\r\n").header("A"), "%0d%0aB: c");
}

TEST(Head, RejectsControlCharacters) {
  for (const std::string& text : {std::string("GET / HTTP/1.1\r\nHost: x\r\nA: b\rc\r\n\r\n"),
                                  std::string("GET / HTTP/1.1\nHost: x\r\n\r\n"),
                                  std::string("GET / HTTP/1.1\r\nHost: x\r\nA: \0\r\n\r\n", 33)})
    EXPECT_THROW(parse_head(text), HttpError) << text;
}

TEST(Head, AcceptsOnlyOneValidHost) {
  const auto parse = [](const std::string& host) {
    return parse_head("GET / HTTP/1.1\r\nHost: " + host + "\r\n\r\n");
  };
  for (const char* host :
       {"", "a", "a.b-c_d~e", "127.0.0.1:8080", "a:", "[::1]", "[::1]:65535", "%41!$&'()*+,;="})
    EXPECT_NO_THROW(parse(host)) << host;
  for (const char* host :
       {"a b", "a/b", "a@b", "a:b",   ":80", "a:65536", "a:1:2",    "[::1", "[x]", "[::1]x",
        "%4",  "%zz", "::1", "a\x80", "a#",  "a?",      "http://a", "a\\b", "<a>", "[fe80::1%25eth0]"})
    EXPECT_THROW(parse(host), HttpError) << host;
  EXPECT_THROW(parse("a\r\nHost: a"), HttpError);
}

TEST(Screening, RejectsNonRequestsEarly) {
  for (const char* text : {"\x16\x03\x01\x02", "GET /\n", "GET / HTTP/1.1\r\nA: b\n", "GET /\r\n",
                           "GET / HTTP/1.1\rX", "hello\r\n", "\r\n", "\n"})
    EXPECT_THROW(screen_head(text, 0), HttpError) << text;
  EXPECT_THROW(screen_head("GET /" + std::string(3000, 'a'), 0), HttpError);
}

TEST(Screening, AcceptsEveryPrefixOfValidRequest) {
  const std::string text = "GET /a HTTP/1.1\r\nHost: x\r\nA: \t \xC3\xA9\r\n\r\n";
  for (std::size_t size = 0; size < text.size(); ++size)
    EXPECT_NO_THROW(screen_head(text.substr(0, size + 1), size)) << size;
}

TEST(Target, ParsesAbsoluteForm) {
  for (const char* text : {"http://a.b:80/c/d?e=f", "HTTP://a.b:80/c/d?e=f", "https://a.b:80/c/d?e=f"}) {
    const Target target = parse_target(text);
    EXPECT_EQ(target.authority, "a.b:80") << text;
    EXPECT_EQ(target.segments, (std::vector<std::string>{"c", "d"})) << text;
    EXPECT_EQ(target.query, (Fields{{"e", "f"}})) << text;
  }
  for (const char* text : {"http://a", "http://a/", "http://a?", "http://[::1]:1"})
    EXPECT_EQ(parse_target(text).path, "/") << text;
  EXPECT_EQ(parse_target("/http://a/b").authority, "");
  for (const char* text : {"http://", "http:///a", "http://?a", "http:a", "http://a@b/", "http://a:b/",
                           "ftp://a/", "http:/a", "http://a b/", "a:80", "*"})
    EXPECT_THROW(parse_target(text), HttpError) << text;
}

TEST(Target, DecodesEachComponent) {
  const Target target = parse_target("/a%2Fb/c?x=1+2&y=%C3%A9&z&&w=%3D");
  EXPECT_EQ(target.segments, (std::vector<std::string>{"a/b", "c"}));
  EXPECT_EQ(target.path, "/a/b/c");
  EXPECT_EQ(target.query, (Fields{{"x", "1 2"}, {"y", "\xC3\xA9"}, {"z", ""}, {"w", "="}}));
  EXPECT_EQ(query_text(target.query), "?x=1%202&y=%C3%A9&z=&w=%3D");
  EXPECT_EQ(query_text({}), "");
}

TEST(Target, RejectsInvalidTargets) {
  for (const char* text :
       {"", "a", "/%", "/%4", "/%zz", "/%00", "/%0A", "/%ff", "/%C0%AF", "/%ED%A0%80", "/?a=1&a=2"})
    EXPECT_THROW(parse_target(text), HttpError) << text;
}

}  // namespace
}  // namespace orrery
