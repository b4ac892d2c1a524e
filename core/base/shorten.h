#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace orrery {

// Whether the byte is a later one of a UTF-8 character.
inline bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

// Number of Unicode characters in valid UTF-8.
inline std::size_t character_count(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return !continues_character(c); }));
}

// The first `characters` characters of valid UTF-8, or all of them. Reads no more than that.
inline std::string_view first_characters(std::string_view text, std::size_t characters) {
  for (std::size_t i = 0; i < text.size(); ++i)
    if (!continues_character(text[i]) && characters-- == 0) return text.substr(0, i);
  return text;
}

// Characters of a name that an error message repeats.
inline constexpr std::size_t kMaxNameCharacters = 128;

// The text, or its first `characters` characters with an ellipsis and the original length:
// "aaaa... (8000000 characters)". Never builds a longer string than it returns.
inline std::string shortened(std::string_view text, std::size_t characters = kMaxNameCharacters) {
  const std::string_view first = first_characters(text, characters);
  if (first.size() == text.size()) return std::string(text);
  return std::string(first) + "... (" + std::to_string(character_count(text)) + " characters)";
}

}  // namespace orrery
