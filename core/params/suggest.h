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

// Returns the candidate that `word` was probably meant to be, or nullopt if none is similar. The case of
// `word` is ignored. Accepts, in this order:
//  - the candidate with the smallest edit distance, at most 2, or 1 for words of up to 3 bytes;
//  - a candidate that `word` abbreviates ("fov" for "fov_degrees"), or the reverse;
//  - the only candidate that begins with `word` ("w" for "width").
// Returns nullopt for words of more than 64 bytes. Candidates after the first kMaxCandidates are ignored.
std::optional<std::string> nearest(std::string_view word, std::span<const std::string_view> candidates);

// Returns the key that `word` was probably meant to be, or nullopt if none is similar. Prefers a key that has
// the meaning of `word` in other programs ("kd" for "albedo", "samples" for "spp") to the result of
// nearest(). REQUIRES: `keys` are declared keys that the object does not contain.
std::optional<std::string> nearest_key(std::string_view word, std::span<const std::string_view> keys);

// Returns ` (did you mean --radius?)` for the name "radius" and the prefix "--", or "" if `name` is nullopt.
// For flags, commands and settings.
std::string question_of(const std::optional<std::string>& name, std::string_view prefix = "");

// Return ` (did you mean "radius"?)`, or "" if no candidate is similar.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);
std::string did_you_mean_key(std::string_view word, std::span<const std::string_view> keys);

}  // namespace orrery
