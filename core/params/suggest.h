#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace orrery {

// Maximum number of candidates searched. Bounds the cost of an invalid document.
inline constexpr std::size_t kMaxCandidates = 1000;

// Returns the optimal string alignment distance: insertions, deletions, replacements and transpositions of
// adjacent characters, where no character is edited twice. Returns limit + 1 if the distance exceeds `limit`.
int edit_distance(std::string_view a, std::string_view b, int limit);

// Returns the candidate that `word` was probably meant to be, or nullopt if none is close. Accepts, in this
// order, a candidate within two edits (case is ignored), an abbreviation ("fov" for "fov_degrees"), and the
// only candidate that begins with `word` ("w" for "width").
std::optional<std::string> nearest(std::string_view word, std::span<const std::string_view> candidates);

// Returns ` (did you mean "radius"?)`, or "" if no candidate is close.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace orrery
