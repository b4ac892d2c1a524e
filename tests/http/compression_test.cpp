#include "server/http/compression.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include "tests/http/daemon.h"

// Tests response compression and its negotiation.
namespace orrery {
namespace {

const std::string kLong(5000, 'x');

// Returns the response after compression for a client that sends this Accept-Encoding.
Response compressed(Response response, const std::string& accepts = "gzip") {
  Request request;
  request.headers = {{"Accept-Encoding", accepts}};
  compress(request, response);
  return response;
}
bool is_compressed(const Response& response) {
  return find_field(response.headers, "Content-Encoding") == "gzip";
}
Response text(const std::string& body = kLong, const char* type = "text/css; charset=utf-8") {
  return text_response(200, type, body);
}

std::string unpacked(std::string_view bytes) {
  std::string text(2 << 20, '\0');
  z_stream stream{};
  inflateInit2(&stream, 15 + 16);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(text.data());
  stream.avail_out = static_cast<uInt>(text.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  text.resize(stream.total_out);
  inflateEnd(&stream);
  return text;
}

TEST(Compression, RoundTripsBody) {
  std::string body;
  for (int i = 0; i < 100'000; ++i) body += std::to_string(i * 7919 % 1000);
  const Response response = compressed(text(body));
  EXPECT_TRUE(is_compressed(response));
  EXPECT_LT(response.body.size(), body.size() / 2);
  EXPECT_EQ(unpacked(response.body), body);
}

TEST(Compression, ReusesStoredCompressedBody) {
  Response kept = text();
  kept.gzip = "kept form";
  const Response response = compressed(kept);
  EXPECT_TRUE(is_compressed(response));
  EXPECT_EQ(std::string_view(response.body), "kept form");
  EXPECT_FALSE(is_compressed(compressed(kept, "identity")));
}

TEST(Compression, HonoursAcceptEncoding) {
  for (const char* accepts :
       {"gzip", "GZIP", "x-gzip", "br, gzip;q=0.1", "*", "identity;q=0, *;q=0.5", "deflate,gzip"})
    EXPECT_TRUE(is_compressed(compressed(text(), accepts))) << accepts;
  for (const char* accepts :
       {"", "identity", "br", "gzip;q=0", "gzip; q=0.000", "gzip;Q=0", "*, gzip;q=0", "gzipped"}) {
    const Response response = compressed(text(), accepts);
    EXPECT_FALSE(is_compressed(response)) << accepts;
    EXPECT_EQ(find_field(response.headers, "Vary"), "Accept-Encoding") << accepts;
  }
}

TEST(Compression, CompressesOnlyTextWithinSizeBounds) {
  for (const char* type : {"application/json", "application/schema+json", "image/svg+xml; charset=utf-8",
                           "text/html", "Application/JSON"})
    EXPECT_TRUE(is_compressed(compressed(text(kLong, type)))) << type;
  for (const char* type : {"image/png", "image/x-exr", "application/octet-stream", ""})
    EXPECT_FALSE(is_compressed(compressed(text(kLong, type)))) << type;
  EXPECT_FALSE(is_compressed(compressed(text(std::string(1023, 'x')))));
  EXPECT_TRUE(is_compressed(compressed(text(std::string(1024, 'x')))));
  EXPECT_TRUE(is_compressed(compressed(text(std::string(1 << 20, 'x')))));
  EXPECT_FALSE(is_compressed(compressed(text(std::string((1 << 20) + 1, 'x')))));
}

// The compressed length could reveal a secret that is in the same response as data chosen by the client.
TEST(Compression, SkipsNoStoreResponses) {
  EXPECT_FALSE(is_compressed(compressed(text().set("Cache-Control", "no-store"))));
  EXPECT_FALSE(is_compressed(compressed(text().set("Cache-Control", "private, no-store"))));
  EXPECT_TRUE(is_compressed(compressed(text().set("Cache-Control", "no-cache"))));
}

TEST(Compression, WeakensETag) {
  EXPECT_EQ(find_field(compressed(text().set("ETag", "\"a\"")).headers, "ETag"), "W/\"a\"");
  EXPECT_EQ(find_field(compressed(text().set("ETag", "\"a\""), "").headers, "ETag"), "\"a\"");
}

// A 304 response has the entity tag of the representation that the client has cached.
TEST(Compression, ReturnsKnownETagInNotModified) {
  const auto tag_for = [](const std::string& known) {
    Request request;
    request.headers = {{"Accept-Encoding", "gzip"}, {"If-None-Match", known}};
    Response response{.status = 304};
    response.set("ETag", "\"a\"");
    compress(request, response);
    return find_field(response.headers, "ETag").value_or("") + " " +
           find_field(response.headers, "Vary").value_or("");
  };
  EXPECT_EQ(tag_for("W/\"a\""), "W/\"a\" Accept-Encoding");
  EXPECT_EQ(tag_for("\"a\""), "\"a\" ");
}

TEST(Compression, ServesAndRevalidatesCompressedPage) {
  const Daemon daemon;
  const auto ask = [&](const std::string& more) {
    const RawClient raw(daemon.port());
    raw.send("GET /app.js HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n" + more + "\r\n");
    return raw.receive_all();
  };
  const std::string plain = ask(""), packed = ask("Accept-Encoding: gzip, deflate, br\r\n");
  EXPECT_LT(packed.size(), plain.size() / 2);
  const std::string body = unpacked(std::string_view(packed).substr(packed.find("\r\n\r\n") + 4));
  EXPECT_EQ(body, plain.substr(plain.find("\r\n\r\n") + 4));
  const std::size_t tag = packed.find("W/\"");
  ASSERT_NE(tag, std::string::npos);
  const std::string etag = packed.substr(tag, packed.find("\r\n", tag) - tag);
  EXPECT_EQ(ask("Accept-Encoding: gzip\r\nIf-None-Match: " + etag + "\r\n").substr(9, 3), "304");
}

}  // namespace
}  // namespace orrery
