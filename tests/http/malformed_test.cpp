#include "tests/http/malformed.h"

#include <algorithm>

#include "tests/http/daemon.h"
#include "tests/support/sanitized.h"

// Tests malformed requests. Each case gets the expected responses, and the daemon continues to serve.
namespace orrery {

void PrintTo(const RawCase& raw, std::ostream* out) { *out << raw.name; }

namespace {

std::vector<RawCase> all_cases() {
  std::vector<RawCase> all = framing_cases();
  for (auto more : {head_cases(), meaning_cases()}) all.insert(all.end(), more.begin(), more.end());
  return all;
}

std::string send(const Daemon& daemon, const std::string& bytes) {
  const RawClient raw(daemon.port());
  raw.send(bytes);
  return raw.receive_all();
}

struct Answer {
  int status = 0;
  std::string head, body;
};

// Returns the value of a header, or "".
std::string header(const Answer& answer, const std::string& name) {
  const std::size_t at = answer.head.find("\r\n" + name + ": ");
  if (at == std::string::npos) return {};
  const std::size_t begin = at + name.size() + 4;
  return answer.head.substr(begin, answer.head.find("\r\n", begin) - begin);
}

// Splits the bytes into responses by Content-Length. Fails the test if they are malformed.
std::vector<Answer> answers_in(std::string bytes) {
  std::vector<Answer> answers;
  while (!bytes.empty()) {
    const std::size_t end = bytes.find("\r\n\r\n");
    if (bytes.rfind("HTTP/1.1 ", 0) != 0 || end == std::string::npos) {
      ADD_FAILURE() << "no complete response in " << bytes;
      break;
    }
    Answer answer{std::stoi(bytes.substr(9, 3)), bytes.substr(0, end + 2), {}};
    const std::string length = header(answer, "Content-Length");
    const std::size_t size = length.empty() ? 0 : std::stoul(length);
    answer.body = bytes.substr(end + 4, size);
    EXPECT_EQ(answer.body.size(), size);
    bytes.erase(0, end + 4 + size);
    answers.push_back(std::move(answer));
  }
  return answers;
}

void expect_problem_of(const Answer& answer) {
  EXPECT_EQ(header(answer, "Content-Type"), "application/problem+json");
  const auto problem = nlohmann::json::parse(answer.body, nullptr, false);
  ASSERT_TRUE(problem.is_object()) << answer.body;
  EXPECT_EQ(problem.value("status", 0), answer.status);
  EXPECT_FALSE(problem.value("detail", "").empty());
  EXPECT_EQ(problem.value("request_id", "?"), header(answer, "X-Request-ID"));
}

class MalformedRequests : public HttpTest, public ::testing::WithParamInterface<RawCase> {};

TEST_P(MalformedRequests, ReturnsExpectedStatusesAndKeepsServing) {
  const std::vector<Answer> answers = answers_in(send(daemon(), GetParam().bytes));
  std::vector<int> statuses;
  for (const Answer& answer : answers) statuses.push_back(answer.status);
  EXPECT_EQ(statuses, GetParam().statuses);
  for (const Answer& answer : answers) {
    if (answer.status >= 400) expect_problem_of(answer);
    EXPECT_EQ(header(answer, "Content-Range"), "");
    EXPECT_EQ(header(answer, "Accept-Ranges"), "");
    EXPECT_EQ(answer.head.find("<script>"), std::string::npos);
  }
  ASSERT_FALSE(answers.empty());
  EXPECT_EQ(header(answers.back(), "Connection"), "close");
  EXPECT_EQ(client_.Get("/healthz")->status, 200);
}

INSTANTIATE_TEST_SUITE_P(Http, MalformedRequests, ::testing::ValuesIn(all_cases()),
                         [](const auto& raw) { return raw.param.name; });

TEST(ResourceUse, StaysBoundedUnderMalformedRequests) {
  constexpr double kMost = test::kSanitized ? 1e12 : 32 << 20;
  const Daemon daemon;
  const std::vector<RawCase> cases = all_cases();
  const auto send_all = [&] {
    for (const RawCase& raw : cases) send(daemon, raw.bytes);
  };
  for (int i = 0; i < 2; ++i) send_all();  // fills buffers that persist
  const double memory = daemon.resident_bytes();
  const std::size_t files = daemon.open_files();
  for (int i = 0; i < (test::kSanitized ? 5 : 50); ++i) send_all();
  EXPECT_LE(daemon.resident_bytes() - memory, kMost);
  EXPECT_LE(daemon.open_files(), files + 2);  // a thread may still be closing
  RecordProperty("growth_bytes", static_cast<int>(daemon.resident_bytes() - memory));
  RecordProperty("cases", static_cast<int>(cases.size()));
}

}  // namespace
}  // namespace orrery
