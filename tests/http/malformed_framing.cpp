#include "tests/http/daemon.h"
#include "tests/http/malformed.h"

namespace orrery {
namespace {

// Returns a POST with the framing headers `headers`, followed by the bytes `after`.
std::string post(const std::string& headers, const std::string& after) {
  return "POST /v1/render HTTP/1.1\r\nHost: x\r\n" + headers + "\r\n" + after;
}

constexpr const char* kInner = "GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n";

// Returns a body in two chunks.
std::string in_chunks(const std::string& body) {
  char size[20];
  std::snprintf(size, sizeof size, "%zX\r\n", body.size() - 1);
  return "1\r\n" + body.substr(0, 1) + "\r\n" + size + body.substr(1) + "\r\n0\r\n\r\n";
}

std::string many(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

}  // namespace

std::vector<RawCase> framing_cases() {
  const std::string chunked = "Transfer-Encoding: chunked\r\n";
  const std::string whole = small_scene().dump();
  const std::string good = post("Content-Length: " + std::to_string(whole.size()) + "\r\n", whole);
  const std::string last = "GET /healthz HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n";
  return {
      // The total length of a chunked body is unknown until its last chunk.
      {"ChunkedThenRequest", post(chunked, in_chunks(whole)) + last, {200, 200}},
      {"ChunkedInCapitals", post("TRANSFER-ENCODING: CHUNKED\r\n", in_chunks(whole)) + last, {200, 200}},
      {"ChunkExtensionAndTrailer",
       post(chunked, "2;a=\"b\"\r\n{}\r\n000\r\nHost: y\r\nA:\r\n\r\n") + last,
       {422, 200}},
      {"ChunkTrailerResemblingRequest", post(chunked, "0\r\n" + std::string(kInner)), {400}},
      {"ChunkWithNegativeSize", post(chunked, "-2\r\n{}\r\n0\r\n\r\n"), {400}},  // CVE-2026-45352
      {"ChunkOf64Bits", post(chunked, "ffffffffffffffff\r\n{}"), {413}},         // CVE-2025-53629
      {"ChunkOver64Bits", post(chunked, "10000000000000002\r\n{}"), {400}},
      {"ChunkOverLimit", post(chunked, "2\r\n{}\r\n7fffff\r\n"), {413}},
      {"ChunkSizeWithPrefix", post(chunked, "0x2\r\n{}\r\n0\r\n\r\n"), {400}},
      {"ChunkSizeWithPlus", post(chunked, "+2\r\n{}\r\n0\r\n\r\n"), {400}},
      {"ChunkSizeWithBlank", post(chunked, "2 \r\n{}\r\n0\r\n\r\n"), {400}},
      {"ChunkSizeAfterBlank", post(chunked, " 2\r\n{}\r\n0\r\n\r\n"), {400}},
      {"ChunkSizeMissing", post(chunked, "\r\n{}\r\n0\r\n\r\n"), {400}},
      {"ChunkSizeEndsWithLineFeed", post(chunked, "2\n{}\r\n0\r\n\r\n"), {400}},
      {"ChunkSizeWithCarriageReturn", post(chunked, "2\r\r\n{}\r\n0\r\n\r\n"), {400}},
      {"ChunkExtensionWithCarriageReturn", post(chunked, "2;a\r\r\n{}\r\n0\r\n\r\n"), {400}},
      {"ChunkTrailerWithCarriageReturn", post(chunked, "0\r\nA: b\r\r\n\r\n"), {400}},
      {"ChunkExtensionWithLineFeed", post(chunked, "2;\n{}\r\n0\r\n\r\n"), {400}},  // CVE-2025-46728
      {"ChunkExtensionTooLong", post(chunked, "2;" + std::string(5000, 'a') + "\r\n{}\r\n0\r\n\r\n"), {400}},
      {"ChunkLongerThanSize", post(chunked, "1\r\n{}\r\n0\r\n\r\n"), {400}},
      {"ChunkFollowedByBytes", post(chunked, "2\r\n{}xx0\r\n\r\n"), {400}},
      {"ChunkEndsWithLineFeed", post(chunked, "2\r\n{}\n0\r\n\r\n"), {400}},
      {"ChunkTrailerWithoutColon", post(chunked, "0\r\nHost\r\n\r\n"), {400}},
      {"ChunkTrailersTooLong",
       post(chunked, "0\r\n" + many("A: " + std::string(200, 'a') + "\r\n", 100) + "\r\n"),
       {400}},
      {"ChunkedTwice", post("Transfer-Encoding: chunked, chunked\r\n", "0\r\n\r\n"), {501}},
      {"ChunkedInTwoHeaders", post(chunked + chunked, "0\r\n\r\n"), {400}},
      {"ChunkedMisspelt", post("Transfer-Encoding: xchunked\r\n", "0\r\n\r\n"), {501}},
      {"CodingIdentity", post("Transfer-Encoding: identity\r\n", "{}"), {501}},
      {"CodingGzip", post("Transfer-Encoding: gzip\r\n", "{}"), {501}},
      {"CodingGzipThenChunked", post("Transfer-Encoding: gzip, chunked\r\n", "0\r\n\r\n"), {501}},
      {"CodingEmpty", post("Transfer-Encoding:\r\n", "{}"), {501}},
      {"CodingAfterVerticalTab",
       post("Transfer-Encoding: \x0B"
            "chunked\r\n",
            "0\r\n\r\n"),
       {400}},
      {"CodingInHttp10", "POST /v1/render HTTP/1.0\r\n" + chunked + "\r\n0\r\n\r\n", {400}},
      {"ChunkedGetContainingRequest",
       "GET /healthz HTTP/1.1\r\nHost: x\r\n" + chunked + "\r\n0\r\n\r\n" + kInner,
       {200}},

      // Two parsers could disagree on the start of the next request (CVE-2026-34441).
      {"LengthAndCoding", post("Content-Length: 5\r\n" + chunked, "0\r\n\r\n" + std::string(kInner)), {400}},
      {"CodingAndLength", post(chunked + "Content-Length: 5\r\n", "0\r\n\r\n" + std::string(kInner)), {400}},
      {"TwoLengths", post("Content-Length: 2\r\nContent-Length: 3\r\n", "{}"), {400}},
      {"TwoEqualLengths", post("Content-Length: 2\r\nContent-Length: 2\r\n", "{}"), {400}},
      {"ListOfEqualLengths", post("Content-Length: 2, 2\r\n", "{}"), {400}},
      {"LengthNegative", post("Content-Length: -1\r\n", ""), {400}},
      {"LengthWithPlus", post("Content-Length: +2\r\n", "{}"), {400}},
      {"LengthHexadecimal", post("Content-Length: 0x2\r\n", "{}"), {400}},
      {"LengthFraction", post("Content-Length: 2.0\r\n", "{}"), {400}},
      {"LengthEmpty", post("Content-Length:\r\n", "{}"), {400}},
      {"LengthOver64Bits", post("Content-Length: 18446744073709551616\r\n", ""), {400}},
      {"LengthOf64Bits", post("Content-Length: 18446744073709551615\r\n", ""), {413}},
      {"LengthOf63Bits", post("Content-Length: 9223372036854775808\r\n", ""), {413}},
      {"LengthOverLimit", post("Content-Length: 8388609\r\n", "{"), {413}},
      {"LengthWithZeros", post("Content-Length: 00000000000000000002\r\nConnection: close\r\n", "{}"), {422}},
      {"LengthWithBlankBeforeColon", post("Content-Length : 2\r\n", "{}"), {400}},
      {"LengthInFoldedLine", post("A: b\r\n Content-Length: 2\r\n", "{}"), {400}},
      {"LengthMissing", post("", "{}"), {411}},
      {"LengthMissingInHttp10", "POST /v1/render HTTP/1.0\r\n\r\n{}", {411}},

      // Bytes after a complete request.
      {"Pipelined", kInner + good + last, {200, 200, 200}},
      {"UnreadBodyIsNotParsedAsRequest",
       "POST /nosuch HTTP/1.1\r\nHost: x\r\nContent-Length: " + std::to_string(std::string(kInner).size()) +
           "\r\n\r\n" + kInner + kInner,
       {404}},
      {"BodyOfGetIsNotParsedAsRequest",
       "GET /healthz HTTP/1.1\r\nHost: x\r\nContent-Length: " + std::to_string(std::string(kInner).size()) +
           "\r\n\r\n" + kInner + kInner,
       {200}},
      {"OversizedBodyIsNotParsedAsRequest", post("Content-Length: 8388609\r\n", kInner), {413}},
      {"BytesAfterBodyBeginNextRequest", good + "X" + last, {200, 501}},
      {"RequestAfterErrorIsIgnored", "GET / HTTP/1.1\r\n\r\n" + last, {400}},
      {"RequestAfterCloseIsIgnored", last + kInner, {200}},
  };
}

}  // namespace orrery
