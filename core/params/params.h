#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/vec3.h"
#include "core/params/document.h"
#include "core/params/names.h"

// The one door for input. A read function states, key by key, what a JSON object may hold:
//
//   void read_sphere(Params& p) {
//     const Vec3d center = p.point("center", "Centre of the sphere, in metres.");
//     const double radius = p.positive("radius", "Radius, in metres.");
//   }
//
// read_document() runs it over a document: values are checked and returned. describe() runs the very same
// function over nothing: what it asks for is written down as JSON Schema. So the two cannot disagree, as long
// as a read function asks for the same keys whatever values come back (choices go through pick and form).
//
// On an error the problem is noted and a harmless stand-in inside the range is returned, so that reading goes
// on and the user sees all problems at once. Do nothing irreversible with a value before the read has ended.

namespace orrery {

inline constexpr double kMaxCoordinate = 1e12;  // metres; beyond it squares of differences lose all meaning
inline constexpr double kMinLength = 1e-12;
inline constexpr double kMaxLength = 1e12;
inline constexpr double kMaxColor = 1e6;
inline constexpr double kMaxInteger = 9007199254740992.0;  // 2^53: up to here a double holds every integer
inline constexpr std::size_t kMaxNameLength = 128;         // characters of a name in each_named()

// Shortest decimal that reads back to the same double, as people write it: 1e12, 0.001, 600.
std::string number_text(double x);

// The numbers allowed; an infinite end is no limit.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool exclusive_min = false;
  bool exclusive_max = false;

  bool contains(double x) const {
    return (exclusive_min ? x > min : x >= min) && (exclusive_max ? x < max : x <= max);
  }
};

// How many elements a list or map may have. A list or map with min 0 may be left out; it is empty then.
struct Count {
  std::size_t min = 0;
  std::size_t max = std::numeric_limits<std::size_t>::max();
};

// What a missing key means: nothing given: the key is required; a value: the default, written in the schema;
// derived(value): a default that depends on other keys, and is named only in the key's description.
template <class T>
struct Fallback {
  std::optional<T> value;
  bool in_schema = true;

  Fallback() = default;
  Fallback(T v) : value(v) {}  // NOLINT: implicit, so that a call site reads p.number(key, doc, range, 0.5)
  Fallback(const char* word) requires std::same_as<T, std::string_view> : value(word) {}  // NOLINT: likewise
};
template <class T>
Fallback<T> derived(T v) {
  Fallback<T> fallback(v);
  fallback.in_schema = false;
  return fallback;
}

// A type that an object may be, for pick(): the text in the file and one sentence for the schema.
struct Choice {
  std::string_view type;
  std::string_view summary;
};

// One JSON object, being read or being described. `key` is a string literal (it is kept by reference);
// `doc` is the sentence that the schema shows. Not for use by several threads at once.
class Params {
 public:
  using Read = std::function<void(Params&)>;
  using ReadNamed = std::function<void(const std::string& name, Params&)>;

  virtual ~Params() = default;
  Params(const Params&) = delete;
  Params& operator=(const Params&) = delete;

  // -- Scalars --
  double number(std::string_view key, std::string_view doc, const Range& range = {},
                Fallback<double> fallback = {});
  double positive(std::string_view key, std::string_view doc,
                  Fallback<double> fallback = {});  // a length, metres
  std::int64_t integer(std::string_view key, std::string_view doc, std::int64_t min, std::int64_t max,
                       Fallback<std::int64_t> fallback = {});  // 3.0 is an integer; |limits| <= 2^53
  bool flag(std::string_view key, std::string_view doc, Fallback<bool> fallback = {});
  std::string choice(std::string_view key, std::string_view doc, std::span<const std::string_view> options,
                     Fallback<std::string_view> fallback = {});
  std::string choice(std::string_view key, std::string_view doc,
                     std::initializer_list<std::string_view> options,
                     Fallback<std::string_view> fallback = {});
  // A list of different options; empty if it is missing.
  std::vector<std::string> choices(std::string_view key, std::string_view doc,
                                   std::span<const std::string_view> options);
  // No fallback (null): the key is required. Its length counts Unicode characters.
  std::string text(std::string_view key, std::string_view doc, std::size_t max_length,
                   const char* fallback = nullptr);

  // -- Threes of numbers --
  Vec3d point(std::string_view key, std::string_view doc, Fallback<Vec3d> fallback = {});  // |x| <= 1e12
  // A non-zero vector, returned with length 1 however long or short it was written. The fallback likewise.
  Vec3d direction(std::string_view key, std::string_view doc, Fallback<Vec3d> fallback = {});
  Vec3d color(std::string_view key, std::string_view doc, Fallback<Vec3d> fallback = {},
              double max = kMaxColor);
  Vec3d coefficient(std::string_view key, std::string_view doc, Fallback<Vec3d> fallback = {},
                    double max = kMaxColor);  // a colour, or one number for all three channels
  std::array<double, 3> numbers3(std::string_view key, std::string_view doc, const Range& range,
                                 Fallback<Vec3d> fallback = {});

  // -- Lists --
  std::vector<Vec3d> points(std::string_view key, std::string_view doc, Count count);  // each as point()
  std::vector<Vec3d> directions(std::string_view key, std::string_view doc,
                                Count count);  // each as direction()
  // Twos of numbers within +-kMaxCoordinate, e.g. texture coordinates.
  std::vector<std::array<double, 2>> pairs(std::string_view key, std::string_view doc, Count count);
  // Threes of integers 0 <= i < bound, e.g. the corners of triangles. The schema cannot know `bound`.
  std::vector<std::array<std::int64_t, 3>> index_triples(std::string_view key, std::string_view doc,
                                                         Count count, std::int64_t bound);

  // -- Objects inside this one. A key in them that `read` did not ask for is an error. --
  void object(std::string_view key, std::string_view doc, const Read& read);           // required
  void optional_object(std::string_view key, std::string_view doc, const Read& read);  // missing reads as {}
  void object_if_given(std::string_view key, std::string_view doc, const Read& read);  // missing: not read
  void each(std::string_view key, std::string_view doc, Count count, const Read& read);
  void each_named(std::string_view key, std::string_view doc, Count count,
                  const ReadNamed& read);  // sorted by name

  // -- Choices between sets of keys --
  // The index of the type named by `key`; none if it is missing or unknown, and then leftover keys are no
  // error.
  std::optional<std::size_t> pick(std::string_view key, std::string_view doc,
                                  std::span<const Choice> choices);

  // Which of several sets of keys is there: form({{"base", "top"}, {"point", "axis"}}) is 0 or 1. Exactly one
  // set must be given, and no key is in two of them. The keys themselves are then read as usual.
  std::size_t form(std::initializer_list<std::initializer_list<std::string_view>> key_sets);

  // The index of a name in `names`, e.g. of the material of an object. 0 on error: good only once the read
  // has ended.
  std::size_t reference(std::string_view key, std::string_view doc, const Names& names);

  // Any value at all, unchecked; none if missing. For what another reader will read.
  std::optional<Document> any(std::string_view key, std::string_view doc);

  // -- Meaning --
  // Whether the key was given. Only for optional keys, and never to decide which keys to ask for: see form().
  bool has(std::string_view key) const;
  // Notes that the value of `key` (or, with "", the object) has no meaning, e.g. eye equal to look_at.
  // Ignored if a value of this object was wrong already: it may be the stand-in that has no meaning.
  void fail(std::string_view key, std::string detail);
  // JSON Pointer of this object, or of its member `key`.
  std::string pointer(std::string_view key = "") const;

 protected:
  // What a three of numbers stands for: decides the checks, the words of errors and the schema.
  enum class Kind { point, direction, color, coefficient, numbers };
  // What a missing object means: a problem, {}, or nothing.
  enum class Missing { problem, empty, nothing };
  using Key = std::string_view;
  using Doc = std::string_view;
  using Options = std::span<const std::string_view>;
  using KeySets = std::initializer_list<std::initializer_list<std::string_view>>;

  Params() = default;

  virtual double do_number(Key, Doc, const Range&, const Fallback<double>&) = 0;
  virtual std::int64_t do_integer(Key, Doc, std::int64_t min, std::int64_t max,
                                  const Fallback<std::int64_t>&) = 0;
  virtual bool do_flag(Key, Doc, const Fallback<bool>&) = 0;
  virtual std::string do_choice(Key, Doc, Options, const Fallback<std::string_view>&) = 0;
  virtual std::vector<std::string> do_choices(Key, Doc, Options) = 0;
  virtual std::string do_text(Key, Doc, std::size_t max_length, const char* fallback) = 0;
  virtual Vec3d do_three(Key, Doc, Kind, const Range&, const Fallback<Vec3d>&) = 0;
  virtual std::vector<Vec3d> do_threes(Key, Doc, Kind, Count) = 0;
  virtual std::vector<std::array<double, 2>> do_pairs(Key, Doc, Count) = 0;
  virtual std::vector<std::array<std::int64_t, 3>> do_triples(Key, Doc, Count, std::int64_t bound) = 0;
  virtual void do_object(Key, Doc, Missing, const Read&) = 0;
  virtual void do_each(Key, Doc, Count, const Read&) = 0;
  virtual void do_each_named(Key, Doc, Count, const ReadNamed&) = 0;
  virtual std::optional<std::size_t> do_pick(Key, Doc, std::span<const Choice>) = 0;
  virtual std::size_t do_form(KeySets) = 0;
  virtual std::size_t do_reference(Key, Doc, const Names&) = 0;
  virtual std::optional<Document> do_any(Key, Doc) = 0;
  virtual bool do_has(Key) const = 0;
  virtual void do_fail(Key, std::string detail) = 0;
  virtual std::string do_pointer(Key) const = 0;
};

// Reads a document, which must be an object. Throws InputError with up to 20 problems, unknown keys among
// them, each with a pointer from the root of the text the document was parsed from.
void read_document(const Document& document, const Params::Read& read);

// The JSON Schema (draft 2020-12) of what `read` accepts, as indented text that ends in a newline. `id` and
// `title` become $id and title; `description` is prose for the whole, to which what a schema cannot say is
// added. It says all that read_document checks except what fail(), reference() and the bound of
// index_triples() check: meaning across keys, which no schema can say.
std::string describe(std::string_view id, std::string_view title, std::string_view description,
                     const Params::Read& read);

}  // namespace orrery
