#include "server/commands/option_help.h"

#include <algorithm>
#include <initializer_list>
#include <variant>

#include "server/commands/help_layout.h"

namespace orrery {
namespace {

std::string names_text(const RenderOption::Names& names) {
  std::string text;
  for (const std::string_view name : names) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

// Return the allowed values, or "" if value_name() of the option shows them.
template <class I>
std::string values_of(const RenderOption::Integer<I>& kind) {
  return range_text(static_cast<double>(kind.min), static_cast<double>(kind.max));
}
std::string values_of(const RenderOption::Number& kind) {
  const Range& range = kind.range;
  if (range.exclusive_min && range.exclusive_max)
    return "above " + number_text(range.min) + " and below " + number_text(range.max);
  return range_text(range.min, range.max);
}
std::string values_of(const RenderOption::Name& kind) { return names_text(kind.names()); }
std::string values_of(const RenderOption::NameList& kind) { return names_text(kind.names()); }
std::string values_of(const auto&) { return ""; }

}  // namespace

std::string_view heading_of(const RenderOption& option) {
  const auto is_one_of = [&](std::initializer_list<std::string_view> keys) {
    return std::find(keys.begin(), keys.end(), option.key) != keys.end();
  };
  if (option.section == Section::camera) return "Camera";
  if (option.section == Section::budget) return "Budget";
  if (is_one_of({"technique", "max_depth", "min_contribution", "path_reuse", "clamp_indirect",
                 "tessellation_error", "interpolation", "energy"}))
    return "Light";
  if (is_one_of({"accelerator", "precision", "ray_sorting", "occluder_prediction"})) return "Speed";
  if (is_one_of({"time", "shutter"})) return "Motion";
  return "Image";
}

std::string help_of(const RenderOption& option) {
  std::string note = std::visit([](const auto& kind) { return values_of(kind); }, option.kind);
  if (!option.by_technique) {  // otherwise `help` states the defaults
    std::string fallback = option.text(default_settings());
    std::erase_if(fallback, [](char c) { return c == '"' || c == '[' || c == ']'; });
    if (fallback.empty()) fallback = "none";
    if (!note.empty()) note += note.find(", ") == std::string::npos ? ", " : "; ";
    note += "default " + fallback;
  }
  std::string_view help = option.help;
  if (help.ends_with('.')) help.remove_suffix(1);
  return std::string(help) + " (" + note + ")";
}

}  // namespace orrery
