// Mistakes of what stands between the network and the service, as faults.mjs has them: fault 17 misreads
// requests, 18 trusts slow clients.

const entry = (fault, about, file, from, to, ...tests) => ({
  fault, about, file: `server/http/${file}`, from, to, target: "test_http", tests,
});
const table = (...names) => names.map((name) => `Http/Malformed.*/${name}`);

export const gateFaults = [
  entry(17, "of two Content-Lengths the last counts", "head.cpp",
        'if (head.content_length) throw HttpError(400, "Content-Length is given twice");', "",
        ...table("TwoLengths", "TwoEqualLengths")),
  entry(17, "Content-Length beside Transfer-Encoding is let through", "head.cpp",
        "if (head.chunked && head.content_length)", "if (false)", ...table("LengthAndCoding", "CodingAndLength")),
  entry(17, "what follows a number is no part of Content-Length", "head.cpp",
        "if (problem != std::errc() || end != value.data() + value.size())", "if (problem != std::errc())",
        ...table("ListOfEqualLengths", "LengthHexadecimal", "LengthFraction")),
  entry(17, "a body that nobody read is the next request", "exchange.cpp",
        "if (exchange.connection.body_unread()) exchange.keep_alive = false;", "",
        ...table("BodyThatNobodyReadsIsNoRequest", "BodyOfAGetIsNoRequest")),
  entry(17, "blanks before the colon of a header are cut off", "head.cpp", "!is_token(name))", "!is_token(trimmed(name)))",
        ...table("BlankBeforeColon", "LengthWithBlankBeforeColon")),
  entry(17, "lines may end with a line feed alone", "head.cpp", "if (after_cr != (byte == '\\n'))",
        "if (after_cr && byte != '\\n')", "Screening.RefusesAtOnceWhatIsNoRequest"),
  entry(17, "of two Hosts one counts", "head.cpp", "if (hosts > 1 ||", "if (", ...table("HostTwice")),
  entry(17, "Host may be anything", "head.cpp", "!value.empty() && !is_authority(value)", "false",
        "Head.HostIsOneHostAndPortOrEmpty", ...table("HostWithPath")),
  entry(17, "an address is judged before its %-escapes", "target.cpp", "require_clean(decoded);", "require_clean(text);",
        ...table("EscapeOfNul", "OverlongSlash")),
  entry(17, "an absolute target is no target", "target.cpp", 'for (const std::string_view scheme : {"http://", "https://"}) {',
        'for (const std::string_view scheme : {"nothing://"}) {', "Conformance.AbsoluteTargetsAreServed"),
  entry(17, "one header too many is read", "head.cpp", "head.headers.size() == kMaxHeaders", "head.headers.size() > kMaxHeaders",
        ...table("Headers101")),
  entry(17, "a head may be one byte too long", "connection.cpp", "if (size > kMaxHeadBytes)", "if (size > kMaxHeadBytes + 1)",
        ...table("HeadOf16385Bytes")),
  entry(17, "an old client is told to go on", "connection.cpp", " && head.minor_version == 1;", ";",
        "Conformance.OldClientsAreNotToldToGoOn"),
  entry(18, "slow clients keep their connections", "server.cpp", "if (make_room()) {", "if (false) {", "SlowClients.Who*"),
  entry(18, "the youngest makes room", "server.cpp", "std::sort(candidates.begin(), candidates.end());",
        "std::sort(candidates.rbegin(), candidates.rend());", "SlowClients.WhoseHeadsTrickle*"),
  entry(18, "the end waits for half a request", "connection.cpp",
        "wait(POLLIN, deadline, true);\n    if (ready != Ready::wake)", "wait(POLLIN, deadline, false);\n    if (ready != Ready::wake)",
        "Terminated.GivesHalfARequestOneLastCall"),
  entry(18, "who leaves after the whole answer left early", "exchange.cpp", "const bool gone = connection.left() ||",
        "const bool gone = exchange.gone.stop_requested() || connection.left() ||", "ClientThatLeaves.AfterTheWholeAnswerHasNotLeftEarly"),
];
