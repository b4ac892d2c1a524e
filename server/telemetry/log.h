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

// Log with one event per line, as JSON or as text. A separate thread writes the lines, so callers never wait
// for the reader. Lines are dropped if the queue is full, or if the reader has stalled or is gone. The number
// of dropped lines is logged before the next line. Thread-safe.
class Log {
 public:
  Log(LogForm form, LogLevel lowest, int fd = STDERR_FILENO);
  // Writes the queued lines, for at most 1 second.
  ~Log();
  Log(const Log&) = delete;

  // Queues a line. `fields` is a JSON object, whose members follow time, level and event.
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
