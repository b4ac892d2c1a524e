#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "core/params/params.h"

// Formats values, limits and pointers for error messages. For core/params only.

namespace orrery {

// Appends the canonical text of a value (see Document::canonical). Stops soon after `out` exceeds `limit`
// bytes, possibly in the middle of a value. The limit bounds the cost of a huge value.
void append_canonical(const nlohmann::json& value, std::string& out,
                      std::size_t limit = std::numeric_limits<std::size_t>::max());

// Returns the canonical text of a value, truncated to 40 characters and "...".
std::string brief(const nlohmann::json& value);

// Returns a name in double quotes with JSON escapes, truncated to 40 characters and "...".
std::string in_quotes(std::string_view name);

// Lists the quoted words: "a", "b" or "c".
std::string one_of(std::span<const std::string_view> words, std::string_view last_join = " or ");

// Lists the allowed words: `"a" or "b"`, `one of "a", "b" or "c"`.
std::string choice_text(std::span<const std::string_view> words);

// Returns "/" and the key, escaped for a JSON Pointer (RFC 6901). Long keys are shortened.
std::string pointer_step(std::string_view key);

// Formats the limits with a leading space: " from 0 to 1", " > 0", " of at least 0". Returns "" if the range
// is unlimited.
std::string range_text(const Range& range);

// Formats the count: "at least 1", "at most 3", "3", "1 to 1024". The caller appends a noun.
std::string count_text(Count count);

// Returns a number inside the range, as a placeholder for an invalid value.
double stand_in(const Range& range);

}  // namespace orrery
