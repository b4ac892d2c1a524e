#include "server/app/log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <nlohmann/json.hpp>

#include "core/base/hash.h"

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

// The same text with its control characters of Latin-1 escaped: a terminal may obey them.
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

// "request  method=GET path=/v1/limits": what is plain stays plain, the rest is quoted.
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

}  // namespace

Log::Log(LogForm form, LogLevel lowest)
    : form_(form),
      logger_(std::make_unique<spdlog::logger>("orrery", std::make_shared<spdlog::sinks::stderr_sink_mt>())) {
  logger_->set_level(level_of(lowest));
  // Time in UTC with milliseconds, and the level; the rest is ours.
  logger_->set_pattern(
      form == LogForm::json ? R"({"time":"%Y-%m-%dT%H:%M:%S.%eZ","level":"%l",%v})" : "%H:%M:%S.%e %-7l %v",
      form == LogForm::json ? spdlog::pattern_time_type::utc : spdlog::pattern_time_type::local);
}

Log::~Log() = default;

void Log::write(LogLevel level, std::string_view event, const ordered_json& fields) const {
  if (!logger_->should_log(level_of(level))) return;
  if (form_ == LogForm::text) return logger_->log(level_of(level), "{}", without_c1(text_of(event, fields)));
  ordered_json line = {{"event", event}};
  line.update(fields);
  const std::string object = dumped(line);
  logger_->log(level_of(level), "{}", std::string_view(object).substr(1, object.size() - 2));
}

}  // namespace orrery
