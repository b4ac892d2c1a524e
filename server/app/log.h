#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace spdlog {
class logger;
}

namespace orrery {

enum class LogForm { json, text };
enum class LogLevel { debug, info, warning, error };

// What the service writes on standard error: an event a line, as a JSON object or for people. Safe from any
// thread.
class Log {
 public:
  Log(LogForm form, LogLevel lowest);
  ~Log();

  // `fields` is an object; its members follow time, level and event.
  void write(LogLevel level, std::string_view event, const nlohmann::ordered_json& fields) const;

 private:
  const LogForm form_;
  std::unique_ptr<spdlog::logger> logger_;
};

}  // namespace orrery
