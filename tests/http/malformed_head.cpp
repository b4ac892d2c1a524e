#include "tests/http/malformed.h"

namespace orrery {
namespace {

using std::string_literals::operator""s;

// Returns a GET of `target` that closes the connection.
std::string get(const std::string& target, const std::string& headers = "") {
  return "GET " + target + " HTTP/1.1\r\nHost: x\r\nConnection: close\r\n" + headers + "\r\n";
}

std::string many_headers(int count) {
  std::string headers;
  for (int i = 0; i < count; ++i) headers += "A: b\r\n";
  return headers;
}

// Returns a head of `size` bytes.
std::string head_of(std::size_t size) {
  const std::string half = "A: " + std::string(8'180, 'a') + "\r\n";
  const std::string rest = get("/healthz", half + "B: \r\n");
  return get("/healthz", half + "B: " + std::string(size - rest.size(), 'b') + "\r\n");
}

}  // namespace

std::vector<RawCase> head_cases() {
  return {
      // Other protocols and versions.
      {"Http09", "GET /healthz\r\n", {400}},
      {"Http2Preface", "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", {505}},
      {"UnknownVersion", "GET / HTTP/1.2\r\nHost: x\r\n\r\n", {505}},
      {"LongVersion", "GET / HTTP/1.10\r\nHost: x\r\n\r\n", {505}},
      {"VersionInLowerCase", "GET / http/1.1\r\nHost: x\r\n\r\n", {400}},
      {"Tls", "\x16\x03\x01\x02\x00\x01\x00\x01\xFC\x03\x03"s + std::string(32, '\x7A') + "\x20", {400}},
      {"Ssh", "SSH-2.0-OpenSSH_9.2\r\n", {400}},
      {"ProxyProtocol", "PROXY TCP4 1.2.3.4 5.6.7.8 1 2\r\nGET / HTTP/1.1\r\nHost: x\r\n\r\n", {400}},
      {"Telnet", "\xFF\xF4\xFF\xFD\x06\r\n", {400}},

      // Lines and bytes.
      {"BareLineFeeds", "GET / HTTP/1.1\nHost: x\n\n", {400}},
      {"BareLineFeedInHeader", "GET / HTTP/1.1\r\nHost: x\r\nA: b\nB: c\r\n\r\n", {400}},
      {"CarriageReturnInHeader", "GET / HTTP/1.1\r\nHost: x\r\nA: b\rB: c\r\n\r\n", {400}},
      {"BareCarriageReturns", "GET / HTTP/1.1\rHost: x\r\r", {400}},
      {"NulInTarget", "GET /\0 HTTP/1.1\r\nHost: x\r\n\r\n"s, {400}},
      {"NulInName", "GET / HTTP/1.1\r\nHo\0st: x\r\n\r\n"s, {400}},
      {"NulInValue", "GET / HTTP/1.1\r\nHost: x\r\nA: \0\r\n\r\n"s, {400}},
      {"DelInValue", get("/", "A: \x7F\r\n"), {400}},
      {"NonAsciiValue", get("/healthz", "A: \xE9\xFF\r\n"), {200}},  // obs-text
      {"NonAsciiName", get("/", "\xC3\xA9: a\r\n"), {400}},
      {"NonAsciiMethod", "G\xC3\x89T / HTTP/1.1\r\nHost: x\r\n\r\n", {400}},
      {"NonAsciiTarget", get("/\xC3\xA9"), {400}},
      {"FoldedHeader", get("/", "A: b\r\n c\r\n"), {400}},
      {"FoldedFirstHeader", "GET / HTTP/1.1\r\n Host: x\r\n\r\n", {400}},
      {"BlankBeforeColon", get("/", "A : b\r\n"), {400}},
      {"TabBeforeColon", get("/", "A\t: b\r\n"), {400}},
      {"NoColon", get("/", "A\r\n"), {400}},
      {"NoName", get("/", ": b\r\n"), {400}},
      {"NameWithBrackets", get("/", "A(b): c\r\n"), {400}},
      {"EmptyValue", get("/healthz", "A:\r\n"), {200}},
      {"TooManyEmptyLines", "\r\n\r\n\r\n\r\n\r\n\r\n\r\n\r\n\r\n" + get("/"), {400}},

      // Request lines.
      {"MethodInLowerCase", "get / HTTP/1.1\r\nHost: x\r\n\r\n", {501}},
      {"MethodUnknown", "BREW / HTTP/1.1\r\nHost: x\r\n\r\n", {501}},
      {"MethodWithInvalidCharacter", "G@T / HTTP/1.1\r\nHost: x\r\n\r\n", {400}},
      {"MethodLong", std::string(1000, 'A') + " / HTTP/1.1\r\nHost: x\r\n\r\n", {501}},
      {"MethodMissing", " / HTTP/1.1\r\nHost: x\r\n\r\n", {400}},
      {"TargetMissing", "GET HTTP/1.1\r\nHost: x\r\n\r\n", {400}},
      {"TwoBlanks", "GET  / HTTP/1.1\r\nHost: x\r\n\r\n", {400}},
      {"BlankInTarget", "GET /a b HTTP/1.1\r\nHost: x\r\n\r\n", {400}},
      {"TabsInsteadOfBlanks", "GET\t/\tHTTP/1.1\r\nHost: x\r\n\r\n", {400}},
      {"BlankAfterVersion", "GET / HTTP/1.1 \r\nHost: x\r\n\r\n", {400}},

      // Targets.
      {"TargetOf2048Bytes", get("/" + std::string(2047, 'a')), {404}},
      {"TargetOf2049Bytes", get("/" + std::string(2048, 'a')), {414}},
      {"TargetWithoutEnd", "GET /" + std::string(20'000, 'a'), {414}},
      {"TargetWithManySegments", get("/" + std::string(2047, '/')), {404}},
      {"TargetWithoutSlash", get("healthz"), {400}},
      {"EscapeIncomplete", get("/%4"), {400}},
      {"EscapeWithoutDigits", get("/%zz"), {400}},
      {"EscapeOfNul", get("/healthz%00"), {400}},
      {"EscapeOfLineEnd", get("/%0d%0aX-A:%20b"), {400}},
      {"OverlongSlash", get("/..%C0%AFetc"), {400}},
      {"OverlongNul", get("/%E0%80%80"), {400}},
      {"Surrogate", get("/%ED%A0%80"), {400}},
      {"BeyondUnicode", get("/%F4%90%80%80"), {400}},
      {"DotsAreNotFolders", get("/%2e%2e/%2e%2e/etc/passwd"), {404}},
      {"QueryNamesTwice", get("/healthz?a=1&a=2"), {400}},
      {"Absolute", get("http://x/healthz"), {200}},
      {"AbsoluteWithoutHost", get("http:///healthz"), {400}},
      {"AbsoluteWithUser", get("http://me@x/healthz"), {400}},
      {"AbsoluteWithOtherScheme", get("gopher://x/healthz"), {400}},
      {"AbsoluteWithoutHostHeader", "GET http://x/healthz HTTP/1.1\r\n\r\n", {400}},
      {"AsteriskWithOptions", "OPTIONS * HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n", {204}},
      {"AsteriskWithGet", get("*"), {400}},
      {"Authority", "CONNECT x:443 HTTP/1.1\r\nHost: x:443\r\n\r\n", {501}},
      {"AuthorityWithGet", get("x:443"), {400}},

      // Host.
      {"HostMissing", "GET / HTTP/1.1\r\n\r\n", {400}},
      {"HostTwice", "GET / HTTP/1.1\r\nHost: x\r\nHost: x\r\n\r\n", {400}},
      {"HostTwiceInHttp10", "GET / HTTP/1.0\r\nHost: x\r\nhost: y\r\n\r\n", {400}},
      {"HostList", "GET / HTTP/1.1\r\nHost: x, y z\r\n\r\n", {400}},
      {"HostWithPath", "GET / HTTP/1.1\r\nHost: x/y\r\n\r\n", {400}},
      {"HostWithUser", "GET / HTTP/1.1\r\nHost: me@x\r\n\r\n", {400}},
      {"HostWithHugePort", "GET / HTTP/1.1\r\nHost: x:99999999999999999999\r\n\r\n", {400}},
      {"HostEmpty", "GET /healthz HTTP/1.1\r\nHost:\r\nConnection: close\r\n\r\n", {200}},

      // Sizes (CVE-2025-53628, CVE-2025-52887).
      {"Headers100", get("/healthz", many_headers(98)), {200}},
      {"Headers101", get("/healthz", many_headers(99)), {431}},
      {"HeadOf16384Bytes", head_of(16384), {200}},
      {"HeadOf16385Bytes", head_of(16385), {431}},
      {"HeaderWithoutEnd", "GET / HTTP/1.1\r\nA: " + std::string(100'000, 'a'), {431}},
      {"HeaderNameLong", get("/healthz", std::string(8'000, 'a') + ": b\r\n"), {200}},
      {"HeaderOf8192Bytes", get("/healthz", "A: " + std::string(8187, 'a') + "\r\n"), {200}},
      {"HeaderOf8193Bytes", get("/healthz", "A: " + std::string(8188, 'a') + "\r\n"), {431}},
      {"HeaderOf8192BytesEscaped", get("/healthz", "A: " + std::string(2729, '%') + "\r\n"), {200}},
      {"TargetWithSecondQuestionMark", get("/healthz?a=b?c", ""), {400}},
  };
}

}  // namespace orrery
