#include "server/telemetry/log.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/eventually.h"

// Tests the log, in particular without a reader.
namespace orrery {
namespace {

using nlohmann::json;

// Pipe for the output of a log. Reads do not block.
class Pipe {
 public:
  Pipe() {
    signal(SIGPIPE, SIG_IGN);
    EXPECT_EQ(pipe2(ends_, O_CLOEXEC), 0);
    fcntl(ends_[0], F_SETFL, O_NONBLOCK);
  }
  ~Pipe() {
    close_reader();
    close(ends_[1]);
  }
  int writer() const { return ends_[1]; }
  void close_reader() {
    if (ends_[0] >= 0) close(ends_[0]);
    ends_[0] = -1;
  }
  // Returns all available bytes.
  std::string read_all() const {
    std::string all, part(1 << 16, '\0');
    for (ssize_t count; (count = read(ends_[0], part.data(), part.size())) > 0;)
      all.append(part, 0, static_cast<std::size_t>(count));
    return all;
  }

 private:
  int ends_[2] = {-1, -1};
};

std::vector<json> parse_lines(const std::string& text) {
  std::vector<json> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(json::parse(line));
  return lines;
}

void write_many(const Log& log, int count) {
  for (int i = 0; i < count; ++i)
    log.write(LogLevel::info, "number", {{"i", i}, {"more", std::string(500, 'x')}});
}

TEST(Log, FlushesQueueOnDestruction) {
  const Pipe pipe;
  {
    const Log log(LogForm::json, LogLevel::info, pipe.writer());
    for (int i = 0; i < 100; ++i) log.write(LogLevel::info, "number", {{"i", i}});
    log.write(LogLevel::debug, "quiet", {});
  }
  const std::vector<json> lines = parse_lines(pipe.read_all());
  ASSERT_EQ(lines.size(), 100U);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(lines[static_cast<std::size_t>(i)].at("i"), i);
  EXPECT_EQ(lines[0].at("level"), "info");
  EXPECT_EQ(lines[0].at("event"), "number");
}

TEST(Log, DropsAndCountsUnreadLines) {
  constexpr int kLines = 10'000;  // 5 MB. The pipe holds 64 KiB, the queue 4,096 lines
  const Pipe pipe;
  {
    const Log log(LogForm::json, LogLevel::info, pipe.writer());
    write_many(log, kLines);
    EXPECT_TRUE(test::eventually([&] { return log.dropped() > kLines - 200; })) << log.dropped();
  }  // the destructor returns although nothing is read
  const std::vector<json> lines = parse_lines(pipe.read_all());
  EXPECT_GT(lines.size(), 50U);
  EXPECT_LT(lines.size(), 200U);
}

TEST(Log, ReportsDroppedLinesOnceReaderResumes) {
  const Pipe pipe;
  const Log log(LogForm::json, LogLevel::info, pipe.writer());
  write_many(log, 1000);
  EXPECT_TRUE(test::eventually([&] { return log.dropped() > 0; }));
  std::string text = pipe.read_all();
  log.write(LogLevel::info, "number", {{"after", true}});
  EXPECT_TRUE(test::eventually([&] { return (text += pipe.read_all()).find("after") != std::string::npos; }));
  std::uint64_t written = 0, reported = 0;
  for (const json& line : parse_lines(text)) {
    written += line.contains("i");
    if (line.at("event") != "log lines dropped") continue;
    EXPECT_EQ(line.at("level"), "warning");
    reported += line.at("count").get<std::uint64_t>();
  }
  EXPECT_GT(reported, 0U);
  EXPECT_EQ(reported, log.dropped());
  EXPECT_EQ(written + reported, 1000U);
}

TEST(Log, ContinuesWithoutReader) {
  Pipe pipe;
  pipe.close_reader();
  const Log log(LogForm::text, LogLevel::info, pipe.writer());
  write_many(log, 100);
  EXPECT_TRUE(test::eventually([&] { return log.dropped() == 100; })) << log.dropped();
}

TEST(Log, TruncatesLongTexts) {
  const Pipe pipe;
  {
    const Log log(LogForm::json, LogLevel::info, pipe.writer());
    log.write(LogLevel::error, "request", {{"error", std::string(1 << 20, 'x')}});
  }
  EXPECT_EQ(parse_lines(pipe.read_all()).at(0).at("error"), std::string(2048, 'x'));
}

}  // namespace
}  // namespace orrery
