#pragma once

#include <charconv>
#include <optional>
#include <string_view>

namespace orrery {

// The number that the whole text is, and nothing beside it; none if it is not, or T cannot hold it.
template <class T>
std::optional<T> number_in(std::string_view text) {
  T number{};
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace orrery
