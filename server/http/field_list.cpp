#include "server/http/field_list.h"

#include <algorithm>
#include <cstdlib>

namespace orrery {

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string joined(const Fields& headers, std::string_view name) {
  std::string all;
  for (const auto& [key, value] : headers)
    if (equal_ignoring_case(key, name)) all += (all.empty() ? "" : ", ") + value;
  return all;
}

bool ends_in_quotes(std::string_view text) {
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (quoted && text[i] == '\\')
      ++i;
    else if (text[i] == '"')
      quoted = !quoted;
  }
  return quoted;
}

std::string_view parameter_of(std::string_view entry, std::string_view name) {
  std::string_view value;
  int count = 0;
  for_each_entry(entry, ';', [&](std::string_view parameter) {
    const std::size_t equals = parameter.find('=');
    if (equals == std::string_view::npos || !equal_ignoring_case(parameter.substr(0, equals), name)) return;
    ++count;
    value = parameter.substr(equals + 1);
    if (value.size() > 1 && value.front() == '"' && value.back() == '"')
      value = value.substr(1, value.size() - 2);
  });
  return count == 1 ? value : std::string_view();
}

double weight_of(std::string_view entry) {
  const std::string_view weight = parameter_of(entry, "q");
  return weight.empty() ? 1 : std::strtod(std::string(weight).c_str(), nullptr);
}

}  // namespace orrery
