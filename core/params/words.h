#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "core/params/params.h"

// How values, limits and places are put into words. For core/params only.

namespace orrery {

// Appends the canonical text of a value (see Document::canonical), or its beginning: stops soon after `limit`
// bytes have been written, in the middle of a value, so that a huge value costs little.
void append_canonical(const nlohmann::json& value, std::string& out,
                      std::size_t limit = std::numeric_limits<std::size_t>::max());

// A value for an error message: its canonical text, cut to 40 characters.
std::string brief(const nlohmann::json& value);

// A name in double quotes, with JSON's escapes, cut to 40 characters.
std::string in_quotes(std::string_view name);

// "a", "b" or "c": every word quoted.
std::string one_of(std::span<const std::string_view> words, std::string_view last_join = " or ");

// "/" and the key, escaped for a JSON Pointer (RFC 6901). A long key is shortened, so that no error repeats
// it.
std::string pointer_step(std::string_view key);

// " > 0 and <= 1e12"; empty for no limits.
std::string range_text(const Range& range);

// "at least 1", "3", "1 to 1024": followed by a noun by the caller.
std::string count_text(Count count);

// A number in the range, to go on with where there is no right one.
double stand_in(const Range& range);

}  // namespace orrery
