#pragma once

#include <string>
#include <string_view>

#include "server/http/message.h"

// Headers whose values are lists (RFC 9110, 5.6.1).
namespace orrery {

std::string_view trimmed(std::string_view text);  // without the blanks and tabs around it

// A header that has several lines is one list.
std::string joined(const Fields& headers, std::string_view name);

// Calls `part` with each entry between separators that stand in no quotes, without the blanks around it.
// Empty ones are none.
template <class Part>
void for_each_entry(std::string_view list, char separator, const Part& part) {
  bool quoted = false;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= list.size(); ++i) {
    if (quoted && i + 1 < list.size() && list[i] == '\\') {
      ++i;  // what it stands before is no end of the quotes
      continue;
    }
    if (i < list.size() && list[i] == '"') quoted = !quoted;
    if (i < list.size() && (quoted || list[i] != separator)) continue;
    if (const auto entry = trimmed(list.substr(begin, i - begin)); !entry.empty()) part(entry);
    begin = i + 1;
  }
}

// Whether quotes that it opens do not end.
bool ends_in_quotes(std::string_view text);

// The value of the parameter `name` among those of an entry, "0.5" of "image/*;q=0.5", without quotes; "" if
// there is none, or several.
std::string_view parameter_of(std::string_view entry, std::string_view name);

// How much an entry is liked, 0..1: its q, or 1.
double weight_of(std::string_view entry);

}  // namespace orrery
