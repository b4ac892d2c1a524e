#include "server/telemetry/log.h"

#include <signal.h>
#include <spdlog/async_logger.h>
#include <spdlog/details/thread_pool.h>
#include <spdlog/sinks/base_sink.h>

#include <atomic>
#include <chrono>
#include <nlohmann/json.hpp>

#include "core/base/hash.h"
#include "server/telemetry/line_writer.h"

namespace orrery {
namespace {

using nlohmann::ordered_json;

spdlog::level::level_enum level_of(LogLevel level) {
  switch (level) {
    case LogLevel::debug: return spdlog::level::debug;
    case LogLevel::info: return spdlog::level::info;
    case LogLevel::warning: return spdlog::level::warn;
    default: return spdlog::level::err;
  }
}

std::string dumped(const ordered_json& value) {
  return value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

// Returns the text with C1 control characters escaped, because a terminal may interpret them.
std::string without_c1(const std::string& utf8) {
  std::string text;
  for (std::size_t i = 0; i < utf8.size(); ++i) {
    const auto next = static_cast<unsigned char>(i + 1 < utf8.size() ? utf8[i + 1] : '\0');
    if (utf8[i] == '\xC2' && next >= 0x80 && next <= 0x9F)
      text += "\\u00" + hex_of({&utf8[++i], 1});
    else
      text += utf8[i];
  }
  return text;
}

// Returns a line such as "request method=GET path=/v1/limits". Values with blanks or special characters are
// quoted.
std::string text_of(std::string_view event, const ordered_json& fields) {
  std::string text(event);
  for (const auto& [name, value] : fields.items()) {
    const bool plain =
        value.is_string() && value.get_ref<const std::string&>().find_first_of(" \"=\\") == std::string::npos;
    const std::string shown = dumped(value);
    text += " " + name + "=" + (plain ? shown.substr(1, shown.size() - 2) : shown);
  }
  return text;
}

// Returns the fields with strings cut to kLongest bytes, because thousands of lines may be queued.
ordered_json cut(ordered_json fields) {
  constexpr std::size_t kLongest = 2048;
  for (auto& value : fields)
    if (value.is_string() && value.get_ref<const std::string&>().size() > kLongest)
      value.get_ref<std::string&>().resize(kLongest);
  return fields;
}

// Blocks all signals on the calling thread. Other threads handle them.
void block_signals() {
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);
}

// Returns the part of a line after its time and level.
std::string line_of(LogForm form, std::string_view event, const ordered_json& fields) {
  if (form == LogForm::text) return without_c1(text_of(event, fields));
  ordered_json line = {{"event", event}};
  line.update(fields);
  const std::string object = dumped(line);
  return object.substr(1, object.size() - 2);
}

}  // namespace

// Writes lines on the log's thread.
class Log::Sink final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  // `queue`: thread pool that calls this sink and counts the lines dropped from its queue.
  Sink(LogForm form, int fd, spdlog::details::thread_pool& queue) : form_(form), queue_(queue), writer_(fd) {}

  std::uint64_t dropped() const { return not_written_ + queue_.overrun_counter(); }
  void drop() { ++not_written_; }
  void close_by(std::chrono::steady_clock::time_point end) { writer_.close_by(end); }

 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    if (!report_dropped() || !write(message)) drop();
  }
  void flush_() override {}

  bool write(const spdlog::details::log_msg& message) {
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    return writer_.write({line.data(), line.size()});
  }
  // Returns false if dropped lines cannot be reported yet.
  bool report_dropped() {
    const std::uint64_t count = dropped();
    if (count == reported_) return true;
    const std::string line = line_of(form_, "log lines dropped", {{"count", count - reported_}});
    if (!write({"orrery", spdlog::level::warn, line})) return false;
    reported_ = count;
    return true;
  }

  const LogForm form_;
  spdlog::details::thread_pool& queue_;
  LineWriter writer_;
  std::atomic<std::uint64_t> not_written_{0};
  std::uint64_t reported_ = 0;  // dropped lines already reported
};

Log::Log(LogForm form, LogLevel lowest, int fd) : form_(form) {
  constexpr std::size_t kQueue = 4096;  // lines
  thread_ = std::make_shared<spdlog::details::thread_pool>(kQueue, 1, block_signals);
  sink_ = std::make_shared<Sink>(form, fd, *thread_);
  logger_ = std::make_shared<spdlog::async_logger>("orrery", sink_, thread_,
                                                   spdlog::async_overflow_policy::overrun_oldest);
  logger_->set_error_handler([sink = sink_](const std::string&) { sink->drop(); });
  logger_->set_level(level_of(lowest));
  // Time with milliseconds (JSON: UTC, text: local time), level and message.
  logger_->set_pattern(
      form == LogForm::json ? R"({"time":"%Y-%m-%dT%H:%M:%S.%eZ","level":"%l",%v})" : "%H:%M:%S.%e %-7l %v",
      form == LogForm::json ? spdlog::pattern_time_type::utc : spdlog::pattern_time_type::local);
}

Log::~Log() {
  sink_->close_by(std::chrono::steady_clock::now() + std::chrono::seconds(1));
  logger_.reset();
  thread_.reset();  // joins the thread that uses the sink
}

void Log::write(LogLevel level, std::string_view event, const ordered_json& fields) const {
  if (logger_->should_log(level_of(level)))
    logger_->log(level_of(level), "{}", line_of(form_, event, cut(fields)));
}

std::uint64_t Log::dropped() const { return sink_->dropped(); }

}  // namespace orrery
