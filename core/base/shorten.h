#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace orrery {

// Returns whether the byte is a UTF-8 continuation byte.
inline bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

// Returns the number of Unicode characters in valid UTF-8.
inline std::size_t character_count(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return !continues_character(c); }));
}

// Returns the first `characters` characters of valid UTF-8, or all characters if there are fewer. Reads at
// most one byte past the returned text.
inline std::string_view first_characters(std::string_view text, std::size_t characters) {
  for (std::size_t i = 0; i < text.size(); ++i)
    if (!continues_character(text[i]) && characters-- == 0) return text.substr(0, i);
  return text;
}

// Returns the number with commas between groups of three digits: 8,388,608.
inline std::string grouped(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (std::size_t at = text.size(); at > 3;) text.insert(at -= 3, ",");
  return text;
}

// Maximum number of characters of a name that an error message quotes.
inline constexpr std::size_t kMaxNameCharacters = 128;

// Returns the text if it has at most `characters` characters. Otherwise returns the first `characters`, an
// ellipsis and the original length: "aaaa... (8000000 characters)". Never builds a string longer than the
// result.
inline std::string shortened(std::string_view text, std::size_t characters = kMaxNameCharacters) {
  const std::string_view first = first_characters(text, characters);
  if (first.size() == text.size()) return std::string(text);
  return std::string(first) + "... (" + std::to_string(character_count(text)) + " characters)";
}

// Returns the names separated by commas, shortened, or "none" if there are none.
template <class List>
std::string shortened_names(const List& names) {
  std::string all;
  for (const auto& name : names) all += (all.empty() ? "" : ", ") + std::string(name);
  return all.empty() ? "none" : shortened(all, 200);
}

}  // namespace orrery
