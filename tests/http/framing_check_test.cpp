#include "server/http/framing_check.h"

#include <gtest/gtest.h>
#include <httplib.h>

#include <algorithm>

#include "server/http/chunk_check.h"
#include "server/http/target.h"

// Each rule of the checks, with an input that cpp-httplib alone accepts.
namespace orrery {
namespace {

// Bytes of a client, and the bytes that a server sends it.
class Wire final : public httplib::Stream {
 public:
  explicit Wire(std::string bytes) : bytes_(std::move(bytes)) {}
  bool is_readable() const override { return true; }
  bool is_writable() const override { return true; }
  ssize_t read(char* to, std::size_t size) override {
    const std::size_t count = std::min(size, bytes_.size() - read_);
    std::copy_n(bytes_.data() + read_, count, to);
    read_ += count;
    return static_cast<ssize_t>(count);
  }
  ssize_t write(const char* bytes, std::size_t size) override {
    sent.append(bytes, size);
    return static_cast<ssize_t>(size);
  }
  void get_remote_ip_and_port(std::string& ip, int& port) const override { ip = "peer", port = 1; }
  void get_local_ip_and_port(std::string& ip, int& port) const override { ip = "local", port = 2; }
  socket_t socket() const override { return 0; }
  std::string unread() const { return bytes_.substr(read_); }

  std::string sent;

 private:
  const std::string bytes_;
  std::size_t read_ = 0;
};

// cpp-httplib without checks.
class BareServer final : private httplib::Server {
 public:
  BareServer() {
    Get(".*", [this](const httplib::Request& request, httplib::Response& response) {
      headers = request.headers;
      response.set_content("0123456789", "text/plain");
    });
    Post(".*",
         [this](const httplib::Request&, httplib::Response& response, const httplib::ContentReader& reader) {
           body.clear();
           const bool whole = reader([this](const char* bytes, std::size_t size) {
             body.append(bytes, size);
             return true;
           });
           response.status = whole ? 200 : 400;
         });
  }
  // Serves one request. Returns the status.
  int serve(const std::string& bytes) {
    Wire wire(bytes);
    bool closed = false;
    process_request(wire, false, closed, nullptr);
    unread = wire.unread();
    return std::stoi("0" + wire.sent.substr(std::min<std::size_t>(9, wire.sent.size()), 3));
  }

  httplib::Headers headers;  // headers of the last GET
  std::string body, unread;  // body of the last POST, and the bytes after the request
};

struct Rule {
  const char* hole;  // behaviour of cpp-httplib 0.11.4
  std::string head;  // without the empty line
  int status;        // status of check_head()
};

std::vector<Rule> rules() {
  const std::string get = "GET / HTTP/1.1\r\n", post = "POST / HTTP/1.1\r\nHost: x\r\n";
  std::string many = get + "Host: x\r\n";
  for (int i = 0; i < 101; ++i) many += "A: b\r\n";
  return {{"skips a line that ends with LF", get + "Host: x\r\nA: b\nC: d\r\n", 400},
          {"skips a header without a colon", get + "Host: x\r\nTransfer-Encoding\r\n", 400},
          {"accepts a blank before the colon", get + "Host: x\r\nContent-Length : 5\r\n", 400},
          {"accepts a folded line", get + "Host: x\r\nA: b\r\n c: d\r\n", 400},
          {"accepts control characters", get + "Host: x\r\nA: b\x01\r\n", 400},
          {"takes the first of two lengths", post + "Content-Length: 0\r\nContent-Length: 5\r\n", 400},
          {"reads the digits of a wrong length", post + "Content-Length: 0x5\r\n", 400},
          {"accepts a sign before the length", post + "Content-Length: +0\r\n", 400},
          {"accepts no Host", get, 400},
          {"takes the first of two Hosts", get + "Host: x\r\nHost: y\r\n", 400},
          {"accepts a Host that is none", get + "Host: a/b@c\r\n", 400},
          {"reads an unknown coding up to the end", post + "Transfer-Encoding: gzip\r\n", 501},
          {"accepts any number of headers", many, 431}};
}

TEST(FramingCheck, ClosesHolesOfTheLibrary) {
  for (const Rule& rule : rules()) {
    BareServer bare;
    EXPECT_EQ(bare.serve(rule.head + "\r\n"), 200) << "cpp-httplib no longer " << rule.hole;
    try {
      check_head(rule.head + "\r\n");
      ADD_FAILURE() << rule.hole;
    } catch (const HttpError& error) {
      EXPECT_EQ(error.status(), rule.status) << rule.hole << ": " << error.what();
    }
  }
}

TEST(FramingCheck, RejectsLengthWithChunks) {
  const std::string head =
      "POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 5\r\nTransfer-Encoding: chunked\r\n\r\n";
  BareServer bare;
  EXPECT_EQ(bare.serve(head + "0\r\n\r\n"), 200) << "cpp-httplib no longer prefers the chunks";
  EXPECT_THROW(check_head(head), HttpError);
  EXPECT_THROW(check_head("POST / HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n"), HttpError);
  EXPECT_THROW(check_head("POST / HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n"
                          "Transfer-Encoding: chunked\r\n\r\n"),
               HttpError);
}

TEST(FramingCheck, PassesHeadersOnUnchanged) {
  const std::string head = "GET / HTTP/1.1\r\nHost: x\r\nA: %0d%0aB: c\r\n\r\n";
  BareServer bare;
  EXPECT_EQ(bare.serve(head), 200);
  EXPECT_EQ(bare.headers.find("A")->second, "\r\nB: c") << "cpp-httplib no longer decodes values";
  EXPECT_EQ(bare.serve(check_head(head).bytes), 200);
  EXPECT_EQ(bare.headers.find("A")->second, "%0d%0aB: c");
}

TEST(FramingCheck, WithholdsHeadersOfTheLibrary) {
  const std::string head = "GET / HTTP/1.1\r\nHost: x\r\nRange: bytes=0-1\r\nREMOTE_ADDR: y\r\n\r\n";
  BareServer bare;
  EXPECT_EQ(bare.serve(head), 206) << "cpp-httplib no longer serves ranges";
  EXPECT_EQ(bare.headers.count("REMOTE_ADDR"), 2u);
  EXPECT_EQ(bare.serve(check_head(head).bytes), 200);
  EXPECT_EQ(bare.headers.count("REMOTE_ADDR"), 1u);
}

TEST(FramingCheck, RejectsHeadersThatTheLibraryCannotRead) {
  const auto with = [](const std::string& value) {
    return "GET / HTTP/1.1\r\nHost: x\r\nA: " + value + "\r\n\r\n";
  };
  EXPECT_NO_THROW(check_head(with(std::string(8000, 'a'))));
  for (const std::string& value : {std::string(8200, 'a'), std::string(3000, '%')}) {
    BareServer bare;
    EXPECT_NE(bare.serve(with(std::string(8200, 'a'))), 200);
    EXPECT_THROW(check_head(with(value)), HttpError);
  }
}

TEST(FramingCheck, ReportsBodyLength) {
  const CheckedHead head =
      check_head("POST /a HTTP/1.1\r\nHost: here\r\ncontent-length: 12\r\nX-A: \t b c \r\n\r\n");
  EXPECT_EQ(head.content_length, 12u);
  EXPECT_FALSE(head.chunked);
  EXPECT_EQ(head.bytes, "POST /a HTTP/1.1\r\nHost: here\r\ncontent-length: 12\r\nX-A: b c\r\n\r\n");
  EXPECT_TRUE(check_head("POST / HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: Chunked\r\n\r\n").chunked);
}

TEST(FramingCheck, RejectsControlCharacters) {
  for (const std::string& text : {std::string("GET / HTTP/1.1\r\nHost: x\r\nA: b\rc\r\n\r\n"),
                                  std::string("GET / HTTP/1.1\nHost: x\r\n\r\n"),
                                  std::string("GET / HTTP/1.1\r\nHost: x\r\nA: \0\r\n\r\n", 33)})
    EXPECT_THROW(check_head(text), HttpError) << text;
}

TEST(FramingCheck, AcceptsOnlyOneValidHost) {
  const auto check = [](const std::string& host) {
    return check_head("GET / HTTP/1.1\r\nHost: " + host + "\r\n\r\n");
  };
  for (const char* host :
       {"", "a", "a.b-c_d~e", "127.0.0.1:8080", "a:", "[::1]", "[::1]:65535", "%41!$&'()*+,;="})
    EXPECT_NO_THROW(check(host)) << host;
  for (const char* host :
       {"a b", "a/b", "a@b", "a:b",   ":80", "a:65536", "a:1:2",    "[::1", "[x]", "[::1]x",
        "%4",  "%zz", "::1", "a\x80", "a#",  "a?",      "http://a", "a\\b", "<a>", "[fe80::1%25eth0]"})
    EXPECT_THROW(check(host), HttpError) << host;
}

// Returns the checked form of a chunked body, received in pieces of `size` bytes.
std::string checked(const std::string& body, std::size_t size) {
  ChunkCheck check({1000, "limit"});
  std::string received, passed;
  for (std::size_t i = 0; i < body.size() && !check.has_ended(); i += size) {
    received += body.substr(i, size);
    check.pass_on(received, passed);
  }
  return check.has_ended() ? passed : "incomplete";
}

TEST(ChunkCheck, ClosesHolesOfTheLibrary) {
  const std::string head = "POST / HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n";
  for (const char* body :
       {"0x2\r\n{}\r\n0\r\n\r\n", "+2\r\n{}\r\n0\r\n\r\n", " 2\r\n{}\r\n0\r\n\r\n", "2 x\r\n{}\r\n0\r\n\r\n",
        "2\n{}\r\n0\r\n\r\n", "2\r\n{}xx0\r\n\r\n", "-0\r\n\r\n", "1\r\n{\n0\r\n\r\n"}) {
    BareServer bare;
    EXPECT_EQ(bare.serve(head + body), 200) << "cpp-httplib no longer accepts " << body;
    for (const std::size_t size : {1, 3, 100}) EXPECT_THROW(checked(body, size), HttpError) << body;
  }
}

TEST(ChunkCheck, PassesBodyOnForTheLibrary) {
  const std::string head = "POST / HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n";
  const std::string body = "2;a=\"b\"\r\nab\r\n0001\r\nc\r\n0\r\nA: b\r\nC:\r\n\r\n";
  BareServer bare;
  EXPECT_EQ(bare.serve(head + body), 400) << "cpp-httplib now accepts trailers";
  for (const std::size_t size : {1, 3, 100}) {
    EXPECT_EQ(checked(body, size), "2\r\nab\r\n0001\r\nc\r\n0\r\n\r\n");
    EXPECT_EQ(bare.serve(head + checked(body, size) + "next"), 200);
    EXPECT_EQ(bare.body, "abc");
    EXPECT_EQ(bare.unread, "next");
  }
}

TEST(ChunkCheck, LimitsBody) {
  for (const char* body : {"3e9\r\n", "ffffffffffffffff\r\n", "3e8\r\n"})
    if (std::string(body) == "3e8\r\n")
      EXPECT_EQ(checked(body, 100), "incomplete");
    else
      EXPECT_THROW(checked(body, 100), HttpError) << body;
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
