#include "tests/http/daemon.h"
#include "tests/http/malformed.h"

namespace orrery {
namespace {

// A POST whose framing headers are `headers`, with bytes after the head.
std::string post(const std::string& headers, const std::string& after) {
  return "POST /v1/render HTTP/1.1\r\nHost: x\r\n" + headers + "\r\n" + after;
}

constexpr const char* kInner = "GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n";

}  // namespace

std::vector<RawCase> framing_cases() {
  const std::string chunked = "Transfer-Encoding: chunked\r\n";
  const std::string whole = small_scene().dump();
  const std::string good = post("Content-Length: " + std::to_string(whole.size()) + "\r\n", whole);
  const std::string last = "GET /healthz HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n";
  return {
      // Chunked bodies have no length to judge (CVE-2025-46728, CVE-2025-53629): never read.
      {"Chunked", post(chunked, "2\r\n{}\r\n0\r\n\r\n"), {411}},
      {"ChunkOfNegativeSize", post(chunked, "-2\r\n{}\r\n0\r\n\r\n"), {411}},  // CVE-2026-45352
      {"ChunkOfHugeSize", post(chunked, "ffffffffffffffff\r\n{}"), {411}},
      {"ChunkExtension", post(chunked, "2;" + std::string(5000, 'a') + "\r\n{}\r\n0\r\n\r\n"), {411}},
      {"ChunkTrailers", post(chunked + "Trailer: Host\r\n", "0\r\nHost: y\r\n\r\n"), {411}},
      {"ChunkedTwice", post("Transfer-Encoding: chunked, chunked\r\n", "0\r\n\r\n"), {411}},
      {"ChunkedInTwoHeaders", post(chunked + chunked, "0\r\n\r\n"), {411}},
      {"ChunkedMisspelt", post("Transfer-Encoding: xchunked\r\n", "0\r\n\r\n"), {411}},
      {"ChunkedInCapitals", post("TRANSFER-ENCODING: CHUNKED\r\n", "0\r\n\r\n"), {411}},
      {"CodingIdentity", post("Transfer-Encoding: identity\r\n", "{}"), {411}},
      {"CodingGzip", post("Transfer-Encoding: gzip\r\n", "{}"), {411}},
      {"CodingGzipThenChunked", post("Transfer-Encoding: gzip, chunked\r\n", "0\r\n\r\n"), {411}},
      {"CodingEmpty", post("Transfer-Encoding:\r\n", "{}"), {411}},
      {"CodingAfterVerticalTab",
       post("Transfer-Encoding: \x0B"
            "chunked\r\n",
            "0\r\n\r\n"),
       {400}},
      {"CodingInOldVersion", "POST /v1/render HTTP/1.0\r\n" + chunked + "\r\n0\r\n\r\n", {411}},
      {"ChunkedGetWithARequestInIt",
       "GET /healthz HTTP/1.1\r\nHost: x\r\n" + chunked + "\r\n0\r\n\r\n" + kInner,
       {200}},

      // Two readers of one of these would disagree where the next request begins (CVE-2026-34441).
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
      {"LengthOverTheLimit", post("Content-Length: 8388609\r\n", "{"), {413}},
      {"LengthWithZeros", post("Content-Length: 00000000000000000002\r\nConnection: close\r\n", "{}"), {422}},
      {"LengthWithBlankBeforeColon", post("Content-Length : 2\r\n", "{}"), {400}},
      {"LengthInTheFold", post("A: b\r\n Content-Length: 2\r\n", "{}"), {400}},
      {"LengthMissing", post("", "{}"), {411}},
      {"LengthMissingInOldVersion", "POST /v1/render HTTP/1.0\r\n\r\n{}", {411}},

      // What follows an answered request.
      {"Pipelined", kInner + good + last, {200, 200, 200}},
      {"BodyThatNobodyReadsIsNoRequest",
       "POST /nosuch HTTP/1.1\r\nHost: x\r\nContent-Length: " + std::to_string(std::string(kInner).size()) +
           "\r\n\r\n" + kInner + kInner,
       {404}},
      {"BodyOfAGetIsNoRequest",
       "GET /healthz HTTP/1.1\r\nHost: x\r\nContent-Length: " + std::to_string(std::string(kInner).size()) +
           "\r\n\r\n" + kInner + kInner,
       {200}},
      {"BodyTooLongIsNoRequest", post("Content-Length: 8388609\r\n", kInner), {413}},
      {"MoreThanTheBodyIsTheNextRequest", good + "X" + last, {200, 501}},
      {"RequestAfterARefusalIsNotHeard", "GET / HTTP/1.1\r\n\r\n" + last, {400}},
      {"RequestAfterCloseIsNotHeard", last + kInner, {200}},
  };
}

}  // namespace orrery
