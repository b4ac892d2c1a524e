#include "tests/http/daemon.h"
#include "tests/http/malformed.h"

namespace orrery {
namespace {

std::string get(const std::string& headers) {
  return "GET /healthz HTTP/1.1\r\nHost: x\r\nConnection: close\r\n" + headers + "\r\n";
}

// Returns a POST of a valid scene with `headers` that closes the connection.
std::string post(const std::string& headers, const std::string& body = small_scene().dump()) {
  return "POST /v1/render HTTP/1.1\r\nHost: x\r\nConnection: close\r\n" + headers +
         "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}

std::string ranges(int count) {
  std::string list = "Range: bytes=0-";
  for (int i = 0; i < count; ++i) list += ",5-" + std::to_string(i);
  return list + "\r\n";
}

}  // namespace

std::vector<RawCase> meaning_cases() {
  const std::string json = "Content-Type: application/json\r\n";
  const std::string multipart = "Content-Type: multipart/form-data; boundary=";
  return {
      // Compressed bodies (CVE-2026-22776) are never decompressed.
      {"BodyGzip", post(json + "Content-Encoding: gzip\r\n", "\x1F\x8B\x08"), {415}},
      {"BodyBrotli", post(json + "Content-Encoding: br\r\n", "\x81"), {415}},
      {"BodyIdentityTwice", post(json + "Content-Encoding: identity, identity\r\n"), {415}},

      // Long multipart headers caused deep recursion in a regular expression (CVE-2026-29076).
      {"Multipart",
       post(multipart + "x\r\n", "--x\r\nContent-Disposition: form-data; name=\"a\"\r\n\r\n1\r\n--x--\r\n"),
       {415}},
      {"MultipartWithLongHeader",
       post(multipart + "x\r\n",
            "--x\r\nContent-Disposition: " + std::string(200'000, 'a') + "\r\n\r\n1\r\n--x--\r\n"),
       {415}},
      {"MultipartWithLongBoundary", post(multipart + std::string(8000, 'b') + "\r\n", "--b"), {415}},
      {"TypeLong", post("Content-Type: " + std::string(8000, 'a') + "/b\r\n"), {415}},
      {"TypeEmpty", post("Content-Type: ;;;\r\n"), {200}},

      // Ranges are not supported, so each is ignored (RFC 9110, 14.2). Many overlapping ranges take no extra
      // time.
      {"Range", get("Range: bytes=0-1\r\n"), {200}},
      {"RangeFromEnd", get("Range: bytes=-1\r\n"), {200}},
      {"RangeBackwards", get("Range: bytes=5-1\r\n"), {200}},
      {"RangeHuge", get("Range: bytes=18446744073709551615-18446744073709551616\r\n"), {200}},
      {"RangesOverlapping", get(ranges(1300)), {200}},
      {"RangeInOtherUnit", get("Range: frames=0-1\r\n"), {200}},
      {"RangeEmpty", get("Range: bytes=\r\n"), {200}},
      {"RangeIf", get("Range: bytes=0-1\r\nIf-Range: \"a\"\r\n"), {200}},
      {"RangeOfImage",
       "GET /v1/scenes/" + std::string(64, '0') + "/frame.png HTTP/1.1\r\nHost: x\r\nConnection: close\r\n" +
           ranges(100) + "\r\n",
       {404}},

      // Header names that some libraries reserve are ordinary headers here (CVE-2025-66570).
      {"HeadersReservedByLibraries",
       get("REMOTE_ADDR: 10.0.0.1\r\nREMOTE_PORT: 1\r\nLOCAL_ADDR: 10.0.0.1\r\nLOCAL_PORT: 1\r\n"),
       {200}},
      {"IdWithMarkup", get("X-Request-ID: <script>\r\n"), {200}},

      // Expectations and other protocols.
      {"ExpectOther", post("Expect: 200-ok\r\n"), {417}},
      {"ExpectInGet", get("Expect: 100-continue\r\n"), {200}},
      {"UpgradeToHttp2",
       get("Connection: Upgrade, HTTP2-Settings\r\nUpgrade: h2c\r\nHTTP2-Settings: "
           "AAMAAABkAAQCAAAAAAIAAAAA\r\n"),
       {200}},
      {"UpgradeToWebSocket",
       get("Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: "
           "AA==\r\n"),
       {200}},
      {"Trace", "TRACE /healthz HTTP/1.1\r\nHost: x\r\nConnection: close\r\nCookie: a\r\n\r\n", {405}},
      {"Patch", "PATCH /healthz HTTP/1.1\r\nHost: x\r\nContent-Length: 2\r\n\r\n{}", {405}},
      {"MethodOverride", get("X-HTTP-Method-Override: DELETE\r\n"), {200}},
      {"OptionsForPath", "OPTIONS /healthz HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n", {204}},

      // Very long lists and queries.
      {"ExpectWithEmptyBody",
       "POST /v1/render HTTP/1.1\r\nHost: a\r\nConnection: close\r\nExpect: 100-continue\r\n"
       "Content-Length: 00\r\n\r\n",
       {400}},
      {"BodyWithLineBreakInHost",
       "POST http://a%0Ab/v1/render HTTP/1.1\r\nHost: a\r\nContent-Length: 2\r\n\r\n{}" +
           std::string("GET /healthz HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n"),
       {422, 200}},
      {"ChunksOverLimitWithLineBreakInHost",
       "POST http://a%0Ab/v1/render HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n800001\r\n"
       "GET /healthz HTTP/1.1\r\nHost: a\r\n\r\n",
       {413}},
      {"AcceptLong", get("Accept: " + std::string(8'000, ',') + "\r\n"), {200}},
      {"AcceptWithManyParameters",
       "GET /v1/scenes/" + std::string(64, '0') +
           "/orbit HTTP/1.1\r\nHost: x\r\nConnection: close\r\nAccept: a/b;" + std::string(8'000, ';') +
           "q=nan\r\n\r\n",
       {404}},
      {"EntityTagsLong",
       "GET / HTTP/1.1\r\nHost: x\r\nConnection: close\r\nIf-None-Match: " + std::string(8'000, 'W') +
           "\r\n\r\n",
       {200}},
      {"ConnectionLong", get("Connection: " + std::string(8'000, ',') + "\r\n"), {200}},
      {"QueryWithManyNames",
       "GET /healthz?" +
           [] {
             std::string query;
             for (int i = 0; i < 300; ++i) query += "a" + std::to_string(i) + "&";
             return query;
           }() +
           " HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n",
       {200}},
      {"BodyWithDeepJson", post(json, std::string(1'000'000, '[')), {422}},
      {"BodyNotUtf8", post(json, "{\"a\": \"\xFF\xFE\"}"), {400}},
  };
}

}  // namespace orrery
