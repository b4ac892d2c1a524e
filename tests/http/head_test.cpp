#include "server/http/head.h"

#include <gtest/gtest.h>

#include "server/http/target.h"

namespace orrery {
namespace {

TEST(Head, TakesARequestApart) {
  const Head head =
      parse_head("POST /v1/render?a=b HTTP/1.1\r\nHost: here\r\ncontent-length: 12\r\nX-A: \t b c \r\n\r\n");
  EXPECT_EQ(head.method, "POST");
  EXPECT_EQ(head.target, "/v1/render?a=b");
  EXPECT_EQ(head.content_length, 12u);
  EXPECT_EQ(head.header("x-a"), "b c");
  EXPECT_TRUE(head.keep_alive);
  EXPECT_FALSE(head.chunked);
}

TEST(Head, ConnectionsLastByVersion) {
  EXPECT_FALSE(parse_head("GET / HTTP/1.0\r\n\r\n").keep_alive);
  EXPECT_TRUE(parse_head("GET / HTTP/1.0\r\nConnection: Keep-Alive\r\n\r\n").keep_alive);
  EXPECT_FALSE(parse_head("GET / HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n").keep_alive);
  EXPECT_FALSE(parse_head("GET / HTTP/1.1\r\nHost: x\r\nConnection: a, Close ,b\r\n\r\n").keep_alive);
  EXPECT_TRUE(parse_head("GET / HTTP/1.1\r\nHost: x\r\nConnection: closed\r\n\r\n").keep_alive);
}

TEST(Head, ValuesAreNotDecoded) {
  EXPECT_EQ(parse_head("GET / HTTP/1.1\r\nHost: x\r\nA: %0d%0aB: c\r\n\r\n").header("A"), "%0d%0aB: c");
}

TEST(Head, RefusesControlCharacters) {
  for (const std::string& text : {std::string("GET / HTTP/1.1\r\nHost: x\r\nA: b\rc\r\n\r\n"),
                                  std::string("GET / HTTP/1.1\nHost: x\r\n\r\n"),
                                  std::string("GET / HTTP/1.1\r\nHost: x\r\nA: \0\r\n\r\n", 33)})
    EXPECT_THROW(parse_head(text), HttpError) << text;
}

TEST(Target, IsDecodedPieceByPiece) {
  const Target target = parse_target("/a%2Fb/c?x=1+2&y=%C3%A9&z&&w=%3D");
  EXPECT_EQ(target.segments, (std::vector<std::string>{"a/b", "c"}));
  EXPECT_EQ(target.path, "/a/b/c");
  EXPECT_EQ(target.query, (Fields{{"x", "1 2"}, {"y", "\xC3\xA9"}, {"z", ""}, {"w", "="}}));
}

TEST(Target, RefusesWhatIsNoText) {
  for (const char* text :
       {"", "a", "/%", "/%4", "/%zz", "/%00", "/%0A", "/%ff", "/%C0%AF", "/%ED%A0%80", "/?a=1&a=2"})
    EXPECT_THROW(parse_target(text), HttpError) << text;
}

}  // namespace
}  // namespace orrery
