#pragma once

#include <unistd.h>

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace spdlog {
class async_logger;
namespace details {
class thread_pool;
}
}  // namespace spdlog

namespace orrery {

enum class LogForm { json, text };
enum class LogLevel { debug, info, warning, error };

// What the service writes on standard error: an event a line, as a JSON object or for people. A thread of its
// own writes the lines, so that no caller waits for the reader. Lines are dropped where the queue is full,
// and where the reader is gone or does not read; the next line that is written follows one with their number.
// Safe from any thread.
class Log {
 public:
  Log(LogForm form, LogLevel lowest, int fd = STDERR_FILENO);
  // Writes what is queued, for at most a second.
  ~Log();
  Log(const Log&) = delete;

  // `fields` is an object; its members follow time, level and event.
  void write(LogLevel level, std::string_view event, const nlohmann::ordered_json& fields) const;

  std::uint64_t dropped() const;  // lines, since the start

 private:
  class Sink;

  const LogForm form_;
  std::shared_ptr<spdlog::details::thread_pool> thread_;
  std::shared_ptr<Sink> sink_;
  std::shared_ptr<spdlog::async_logger> logger_;
};

}  // namespace orrery
