#include "core/params/suggest.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "core/params/words.h"

namespace orrery {
namespace {

constexpr int kMaxSlips = 2;          // maximum edit distance of a suggestion
constexpr std::size_t kMaxWord = 64;  // bytes; longer words get no suggestion

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

// Returns the text without "_", "-" and spaces, in lower case, and with "color" for "colour": "diffusecolor"
// for "Diffuse_Colour".
std::string plain_letters(std::string_view text) {
  std::string letters = lower_case(text);
  std::erase_if(letters, [](char c) { return c == '_' || c == '-' || c == ' '; });
  if (const std::size_t at = letters.find("colour"); at != letters.npos) letters.erase(at + 4, 1);
  return letters;
}

// Word of other programs, and the keys with the same meaning in order of preference. The first key that the
// object may still contain is suggested.
struct Synonym {
  std::string_view word;
  std::array<std::string_view, 6> keys;
};
constexpr Synonym kSynonyms[] = {
    {"albedo", {"kd", "reflectance", "base_color", "diffuse"}},
    {"diffuse", {"kd", "reflectance", "base_color"}},
    {"diffusecolor", {"kd", "reflectance", "base_color", "diffuse"}},
    {"color", {"kd", "reflectance", "base_color", "diffuse", "intensity", "radiance"}},
    {"ambient", {"ka"}},
    {"ambientcolor", {"ka"}},
    {"specular", {"ks"}},
    {"specularcolor", {"ks", "specular"}},
    {"exponent", {"shininess"}},
    {"emissive", {"emission"}},
    {"emit", {"emission"}},
    {"emitted", {"emission"}},
    {"eta", {"ior", "n"}},
    {"index", {"ior", "n"}},
    {"refractiveindex", {"ior", "n"}},
    {"indexofrefraction", {"ior", "n"}},
    {"position", {"eye", "center", "point", "corner", "translate"}},
    {"pos", {"eye", "center", "position", "point", "corner", "translate"}},
    {"origin", {"eye", "center", "position", "point", "corner", "translate"}},
    {"location", {"eye", "center", "position", "point", "corner", "translate"}},
    {"from", {"eye", "position"}},
    {"lookfrom", {"eye"}},
    {"target", {"look_at"}},
    {"lookat", {"look_at"}},
    {"look", {"look_at"}},
    {"fov", {"fov_degrees"}},
    {"angle", {"fov_degrees", "degrees", "angle_degrees", "outer_degrees"}},
    {"transform", {"translate"}},
    {"matrix", {"translate"}},
    {"translation", {"translate"}},
    {"rotation", {"rotate"}},
    {"size", {"width", "radius", "scale"}},
    {"resolution", {"width"}},
    {"spp", {"samples"}},
    {"samplesperpixel", {"samples"}},
    {"bounces", {"max_depth", "depth"}},
    {"maxbounces", {"max_depth", "depth"}},
    {"depth", {"max_depth"}},
    {"vertices", {"positions"}},
    {"points", {"positions", "vertices"}},
    {"faces", {"indices"}},
    {"triangles", {"indices"}},
    {"filename", {"file"}},
    {"path", {"file"}},
};

// Returns the maximum edit distance for a word of this length. Two edits in a word of three letters would
// match almost anything.
int slips_allowed(std::size_t length) { return std::min(kMaxSlips, static_cast<int>((length + 2) / 3)); }

// Returns the candidate that begins with `word`, or nullopt unless there is exactly one.
std::optional<std::string> only_one_beginning_with(std::string_view word,
                                                   std::span<const std::string_view> candidates) {
  std::optional<std::string> found;
  for (const std::string_view candidate : candidates) {
    if (word.empty() || !candidate.starts_with(word)) continue;
    if (found) return std::nullopt;
    found = candidate;
  }
  return found;
}

std::string in_quotes_if_any(const std::optional<std::string>& name) {
  return name ? question_of(in_quotes(*name)) : "";
}

}  // namespace

std::string question_of(const std::optional<std::string>& name, std::string_view prefix) {
  return name ? " (did you mean " + std::string(prefix) + *name + "?)" : "";
}

int edit_distance(std::string_view a, std::string_view b, int limit) {
  const std::size_t gap = a.size() > b.size() ? a.size() - b.size() : b.size() - a.size();
  const auto band = static_cast<std::size_t>(limit);  // cells further from the diagonal exceed the limit
  if (gap > band) return limit + 1;
  std::vector<int> before(b.size() + 1, limit + 1), last = before, row = before;  // rows i-2, i-1, i
  for (std::size_t j = 0; j <= std::min(b.size(), band); ++j) last[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    const std::size_t first = i > band ? i - band : 0, end = std::min(b.size(), i + band);
    int least = row[first] = first == 0 ? static_cast<int>(i) : limit + 1;
    for (std::size_t j = std::max<std::size_t>(first, 1); j <= end; ++j) {
      const int left = j > first ? row[j - 1] : limit + 1, above = j < i + band ? last[j] : limit + 1;
      row[j] = std::min({above + 1, left + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
      least = std::min(least, row[j]);
    }
    if (least > limit) return limit + 1;
    before.swap(last);
    last.swap(row);
  }
  return std::min(last[b.size()], limit + 1);
}

std::optional<std::string> nearest(std::string_view word, std::span<const std::string_view> candidates) {
  if (word.size() > kMaxWord) return std::nullopt;
  candidates = candidates.first(std::min(candidates.size(), kMaxCandidates));
  const std::string wanted = lower_case(word);
  int best = slips_allowed(wanted.size()) + 1;
  std::optional<std::string> found;
  for (const std::string_view candidate : candidates) {
    const int distance = edit_distance(wanted, lower_case(candidate), best - 1);
    if (distance < best) {
      best = distance;
      found = candidate;
    }
    if (best == 0) return found;
  }
  if (found) return found;
  for (const std::string_view candidate : candidates) {
    const bool abbreviates = wanted.size() >= 3 && candidate.starts_with(wanted + "_");
    const bool elaborates = candidate.size() >= 3 && wanted.starts_with(std::string(candidate) + "_");
    if (abbreviates || elaborates) return std::string(candidate);
  }
  return only_one_beginning_with(wanted, candidates);
}

std::optional<std::string> nearest_key(std::string_view word, std::span<const std::string_view> keys) {
  if (word.size() > kMaxWord) return std::nullopt;
  const std::string letters = plain_letters(word);
  const auto synonym = std::find_if(std::begin(kSynonyms), std::end(kSynonyms),
                                    [&](const Synonym& s) { return s.word == letters; });
  if (synonym != std::end(kSynonyms))
    for (const std::string_view key : synonym->keys)
      if (!key.empty() && std::find(keys.begin(), keys.end(), key) != keys.end()) return std::string(key);
  return nearest(word, keys);
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates) {
  return in_quotes_if_any(nearest(word, candidates));
}

std::string did_you_mean_key(std::string_view word, std::span<const std::string_view> keys) {
  return in_quotes_if_any(nearest_key(word, keys));
}

}  // namespace orrery
