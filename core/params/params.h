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

// Declarative input. A read function declares, key by key, the content of a JSON object:
//
//   void read_sphere(Params& p) {
//     const Vec3d center = p.point("center", "Centre of the sphere, in metres.");
//     const double radius = p.positive("radius", "Radius, in metres.");
//   }
//
// read_document() runs the function over a document, checks the values and returns them. describe() runs the
// same function without a document and writes the declared keys as a JSON Schema. Reader and schema therefore
// agree, provided that the function declares the same keys for all values. Alternatives must use pick() or
// form().
//
// For an invalid value, the reader records a problem and returns the default, or a placeholder inside the
// range. Reading continues, so one InputError reports up to InputError::kMaxProblems problems. Values may be
// placeholders until read_document() has returned. Until then, use them only in checks that call fail().
//
// read_document() and describe() are thread-safe.

namespace orrery {

inline constexpr double kMaxCoordinate = 1e12;  // maximum absolute coordinate, metres
inline constexpr double kMinLength = 1e-12;     // range of positive(), metres
inline constexpr double kMaxLength = 1e12;
inline constexpr double kMaxColor = 1e6;                   // default maximum of a colour component
inline constexpr double kMaxInteger = 9007199254740992.0;  // 2^53; double is exact up to here
inline constexpr std::size_t kMaxNameLength = 128;         // characters of a name in each_named()

// Returns the shortest decimal that reads back to the same double: 1e12, 0.001, 600.
std::string number_text(double x);

// Range of allowed numbers. An infinite end means no limit.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool exclusive_min = false;
  bool exclusive_max = false;

  bool contains(double x) const {
    return (exclusive_min ? x > min : x >= min) && (exclusive_max ? x < max : x <= max);
  }
};

// Allowed number of entries in a list or map. If `min` is 0, a missing key means an empty list or map.
struct Count {
  std::size_t min = 0;
  std::size_t max = std::numeric_limits<std::size_t>::max();
};

// Value used for a missing key. An empty Fallback makes the key required. The schema shows the value as the
// default. derived(value) is a default that depends on other keys. The schema does not show it.
template <class T>
struct Fallback {
  std::optional<T> value;
  bool in_schema = true;

  Fallback() = default;
  Fallback(T v) : value(v) {}  // NOLINT: implicit, so that a call site reads p.number(key, doc, range, 0.5)
  Fallback(const char* word) requires std::same_as<T, std::string_view> : value(word) {
  }  // NOLINT: implicit, see above
};
template <class T>
Fallback<T> derived(T v) {
  Fallback<T> fallback(v);
  fallback.in_schema = false;
  return fallback;
}

// Type that pick() may select: its name in the document, and one sentence that describes it in the schema.
struct Choice {
  std::string_view type;
  std::string_view summary;
};

// One JSON object that is read or described. `key` must have static storage, as a string literal has, because
// only a reference to it is stored. `doc` is the description in the schema. Not thread-safe.
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
                  Fallback<double> fallback = {});  // metres, kMinLength to kMaxLength
  std::int64_t integer(std::string_view key, std::string_view doc, std::int64_t min, std::int64_t max,
                       Fallback<std::int64_t> fallback = {});  // accepts 3.0; limits within +-2^53
  bool flag(std::string_view key, std::string_view doc, Fallback<bool> fallback = {});
  std::string choice(std::string_view key, std::string_view doc, std::span<const std::string_view> options,
                     Fallback<std::string_view> fallback = {});
  std::string choice(std::string_view key, std::string_view doc,
                     std::initializer_list<std::string_view> options,
                     Fallback<std::string_view> fallback = {});
  // Reads a list of distinct options. Returns an empty list if the key is missing.
  std::vector<std::string> choices(std::string_view key, std::string_view doc,
                                   std::span<const std::string_view> options);
  // Reads a string of at most `max_length` Unicode characters. The key is required if `fallback` is null.
  std::string text(std::string_view key, std::string_view doc, std::size_t max_length,
                   const char* fallback = nullptr);

  // -- Triples of numbers --
  // Reads three coordinates within +-kMaxCoordinate.
  Vec3d point(std::string_view key, std::string_view doc, Fallback<Vec3d> fallback = {});
  // Reads a non-zero vector and normalizes it. The fallback is normalized too.
  Vec3d direction(std::string_view key, std::string_view doc, Fallback<Vec3d> fallback = {});
  Vec3d color(std::string_view key, std::string_view doc, Fallback<Vec3d> fallback = {},
              double max = kMaxColor);  // components from 0 to `max`
  Vec3d coefficient(std::string_view key, std::string_view doc, Fallback<Vec3d> fallback = {},
                    double max = kMaxColor);  // a colour, or one number for all channels
  std::array<double, 3> numbers3(std::string_view key, std::string_view doc, const Range& range,
                                 Fallback<Vec3d> fallback = {});

  // -- Lists --
  std::vector<Vec3d> points(std::string_view key, std::string_view doc,
                            Count count);  // elements as in point()
  std::vector<Vec3d> directions(std::string_view key, std::string_view doc,
                                Count count);  // elements as in direction()
  // Reads a list of numbers, e.g. weights. If `count.min` is 0, a missing key means an empty list.
  std::vector<double> numbers(std::string_view key, std::string_view doc, Count count, const Range& range);
  // Reads a list of pairs of numbers within +-kMaxCoordinate, e.g. texture coordinates.
  std::vector<std::array<double, 2>> pairs(std::string_view key, std::string_view doc, Count count);
  // Reads a list of integer triples with 0 <= i < bound, e.g. triangle indices. The schema does not show
  // `bound`.
  std::vector<std::array<std::int64_t, 3>> index_triples(std::string_view key, std::string_view doc,
                                                         Count count, std::int64_t bound);

  // -- Nested objects. A key that `read` does not declare is an error. --
  void object(std::string_view key, std::string_view doc, const Read& read);  // required
  void optional_object(std::string_view key, std::string_view doc,
                       const Read& read);  // a missing object is read as {}
  void object_if_given(std::string_view key, std::string_view doc,
                       const Read& read);  // `read` is not called if the object is missing
  // Runs `read` if the value of `key` is an object, and returns whether it is. Otherwise the caller reads
  // `key`, which may then be an object or the value that the caller declares. `name` and `doc` describe the
  // object in the schema. REQUIRES: `read` declares the same keys in every call with the same name.
  bool object_instead(std::string_view key, std::string_view name, std::string_view doc, const Read& read);
  void each(std::string_view key, std::string_view doc, Count count, const Read& read);
  void each_named(std::string_view key, std::string_view doc, Count count,
                  const ReadNamed& read);  // in byte order of the names

  // -- Alternatives --
  //
  // Returns the index in `choices` of the type named by `key`. If `key` is missing or names no such type,
  // reports an error and returns nullopt. Unknown keys of the object are then not reported.
  std::optional<std::size_t> pick(std::string_view key, std::string_view doc,
                                  std::span<const Choice> choices);

  // Returns the index of the key set that the object uses: form({{"base", "top"}, {"point", "axis"}}) is 0 or
  // 1. Reports an error if keys of several sets are present. Reports an error if none is present, unless one
  // set is empty. The caller then reads the keys of the selected set. REQUIRES: the sets are disjoint.
  std::size_t form(std::initializer_list<std::initializer_list<std::string_view>> key_sets);

  // Returns the index in `names` of the name at `key`, e.g. the material of an object. If `key` is missing or
  // its name is not in `names`, reports an error and returns 0.
  std::size_t reference(std::string_view key, std::string_view doc, const Names& names);

  // Returns the unchecked value of `key`, for another function to read, or nullopt if the key is missing.
  std::optional<Document> any(std::string_view key, std::string_view doc);

  // -- Validation across keys --
  //
  // Returns whether the key is present. For optional keys only. Must not decide which keys are read: use
  // form().
  bool has(std::string_view key) const;
  // Reports that the value of `key` is invalid, e.g. eye equal to look_at. If `key` is "", the problem points
  // to the object. Ignored if a value in this object or in one inside it was already invalid, since the
  // checked values may then be placeholders.
  void fail(std::string_view key, std::string detail);
  // Returns the JSON Pointer of this object or of its member `key`.
  std::string pointer(std::string_view key = "") const;

 protected:
  // Kind of a triple of numbers. Determines the checks, the error text and the schema.
  enum class Kind { point, direction, color, coefficient, numbers };
  // Handling of a missing object: report an error, read it as {}, or skip it.
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
  virtual std::vector<double> do_numbers(Key, Doc, Count, const Range&) = 0;
  virtual std::vector<std::array<double, 2>> do_pairs(Key, Doc, Count) = 0;
  virtual std::vector<std::array<std::int64_t, 3>> do_triples(Key, Doc, Count, std::int64_t bound) = 0;
  virtual void do_object(Key, Doc, Missing, const Read&) = 0;
  virtual bool do_object_instead(Key, std::string_view name, Doc, const Read&) = 0;
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

// Reads a document with `read`. Throws InputError with up to 20 problems if the document is not an object,
// has invalid values or has unknown keys. Each problem has a pointer from the root of the parsed text.
void read_document(const Document& document, const Params::Read& read);

// Returns the JSON Schema (draft 2020-12) of `read` as indented text that ends in a newline. `id` and `title`
// become $id and title. `description` describes the whole schema. A note on conditions that a schema cannot
// express is appended to it. The schema covers all checks of read_document() except calls of fail(), the
// names known to reference(), and the bound of index_triples().
std::string describe(std::string_view id, std::string_view title, std::string_view description,
                     const Params::Read& read);

}  // namespace orrery
