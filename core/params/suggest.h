#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace orrery {

// Candidates that are searched, at most: a bad document must not cost much.
inline constexpr std::size_t kMaxCandidates = 1000;

// Number of single-character insertions, deletions, replacements and swaps of neighbours that turn a into b
// (optimal string alignment: no character is edited twice), or limit + 1 if it takes more than `limit`.
int edit_distance(std::string_view a, std::string_view b, int limit);

// The candidate that `word` was probably meant to be: equal but for case, at most two slips of the finger
// away, the one it abbreviates ("fov" for "fov_degrees") or the only one that begins with it ("w" for
// "width"). None if all are too far.
std::optional<std::string> nearest(std::string_view word, std::span<const std::string_view> candidates);

// ` (did you mean "radius"?)`, or nothing.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace orrery
