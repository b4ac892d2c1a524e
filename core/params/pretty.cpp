#include "core/params/describer.h"

namespace orrery {
namespace {

constexpr std::size_t kLineWidth = 110;

// Formats a value as one line: {"a": 1, "b": [1, 2]}.
std::string one_line(const Schema& value) {
  if (!value.is_structured()) return value.dump();
  std::string text;
  for (const auto& [key, member] : value.items()) {
    if (!text.empty()) text += ", ";
    if (value.is_object()) text += Schema(key).dump() + ": ";
    text += one_line(member);
  }
  return value.is_object() ? "{" + text + "}" : "[" + text + "]";
}

// Appends a value. `indent` is the indentation of its line. `used` is the number of columns that the line
// needs besides the value: indentation, key and comma.
void append(const Schema& value, std::size_t indent, std::size_t used, std::string& out) {
  const std::string line = one_line(value);
  if (line.size() + used <= kLineWidth || !value.is_structured()) {
    out += line;
    return;
  }
  out += value.is_object() ? "{\n" : "[\n";
  const std::string margin(indent + 2, ' ');
  bool first = true;
  for (const auto& [key, member] : value.items()) {
    const std::string label = value.is_object() ? Schema(key).dump() + ": " : "";
    out += (first ? "" : ",\n") + margin + label;
    append(member, indent + 2, margin.size() + label.size() + 1, out);
    first = false;
  }
  out += "\n" + std::string(indent, ' ') + (value.is_object() ? "}" : "]");
}

}  // namespace

std::string pretty(const Schema& schema) {
  std::string text;
  append(schema, 0, 0, text);
  return text;
}

}  // namespace orrery
