#pragma once

#include <string>
#include <string_view>

#include "server/http/message.h"

// Header fields whose values are lists (RFC 9110, 5.6.1).
namespace orrery {

// Returns `text` without leading and trailing blanks and tabs.
std::string_view trimmed(std::string_view text);

// Returns the values of all fields with this name as one list, separated by ", ".
std::string joined(const Fields& headers, std::string_view name);

// Calls `part` with each trimmed entry of the list. Ignores separators in quotes and skips empty entries.
template <class Part>
void for_each_entry(std::string_view list, char separator, const Part& part) {
  bool quoted = false;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= list.size(); ++i) {
    if (quoted && i + 1 < list.size() && list[i] == '\\') {
      ++i;  // skips the escaped character
      continue;
    }
    if (i < list.size() && list[i] == '"') quoted = !quoted;
    if (i < list.size() && (quoted || list[i] != separator)) continue;
    if (const auto entry = trimmed(list.substr(begin, i - begin)); !entry.empty()) part(entry);
    begin = i + 1;
  }
}

// Whether `text` ends within a quoted string.
bool ends_in_quotes(std::string_view text);

// Returns the unquoted value of parameter `name` of a list entry: "0.5" for `q` in "image/*;q=0.5".
// Returns "" if the parameter is missing or repeated.
std::string_view parameter_of(std::string_view entry, std::string_view name);

// Returns the weight of an entry: its parameter q, 0 to 1 if well-formed, or 1 without it (RFC 9110, 12.4.2).
double weight_of(std::string_view entry);

}  // namespace orrery
