#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/model/camera.h"
#include "core/model/render_settings.h"
#include "core/params/params.h"

// Table of the render options, one row per option. The following derive from it: reader and schema of scenes
// and requests, query parameters, flags, limits, cache key and ETag of an image, explain, statistics and
// OpenAPI. The table is immutable and all functions are thread-safe. Functions that read from Params record
// problems in it and throw what it throws. Only the require_*() functions throw InputError themselves.
namespace orrery {

struct Scene;
struct TechniqueType;

// Member of the request JSON that contains an option.
enum class Section { camera, image, render, budget };
inline constexpr std::array kSections{Section::camera, Section::image, Section::render, Section::budget};
std::string_view name_of(Section section);

struct RenderOption {
  template <class V>
  using Member = std::optional<V> RenderSettings::*;
  using Names = std::vector<std::string_view>;

  // Kinds of values: the member of RenderSettings, the allowed values and the default.
  template <class I>
  struct Integer {
    Member<I> member;
    std::int64_t min, max, fallback;
  };
  struct Number {
    Member<double> member;
    Range range;
    double fallback;
  };
  struct Flag {
    Member<bool> member;
    bool fallback;
  };
  struct Point {  // coordinates in metres; default: the origin
    Member<Vec3d> member;
  };
  struct Name {  // name from a registry
    Member<std::string> member;
    Names (*names)();
    const char* fallback;
  };
  template <class E>
  struct Enumeration {  // names[i] is the name of E(i); default: the first
    Member<E> member;
    std::span<const std::string_view> names;
  };
  struct NameList {  // distinct names from a registry; default: empty
    Member<std::vector<std::string>> member;
    Names (*names)();
  };
  using Kind =
      std::variant<Integer<int>, Integer<std::uint64_t>, Number, Flag, Point, Name, Enumeration<Precision>,
                   Enumeration<Prediction>, Enumeration<Filter>, Enumeration<Interpolation>,
                   Enumeration<Space>, Enumeration<OnMiss>, Enumeration<View>, NameList>;

  // Name in JSON and in queries. The command line spells it with hyphens after "--".
  std::string_view key;
  std::string_view short_name = {};  // alias in queries and flags; may be empty
  Section section;
  Kind kind;
  std::string_view placeholder = {};  // name of the value in help, e.g. PIXELS; if empty, its choices
  std::string_view help;              // description in schemas and in help; ends with a full stop
  bool in_scene = true;               // a scene may set the option, as the default for requests
  bool changes_pixels = true;         // a different value may change the image
  // Returns the default for a technique. Null unless the default of this integer option depends on the
  // technique. Schemas do not show such a default.
  int (*by_technique)(const TechniqueType&) = nullptr;

  std::string pointer() const;     // JSON Pointer in a request: "/camera/azimuth_degrees"
  std::string value_name() const;  // "DEGREES", "true|false"
  Names choices() const;           // allowed words; empty for numbers and points

  // JSON type of a value, for code that converts text to JSON.
  enum class Form { number, boolean, string, numbers, strings };
  Form form() const;

  bool given(const RenderSettings& settings) const;
  // Copies the value. Removes the value of `to` if `from` has none.
  void copy(const RenderSettings& from, RenderSettings& to) const;
  // Returns the value as JSON text. Different values have different texts. REQUIRES: given(settings).
  std::string text(const RenderSettings& settings) const;

  // Read and check the value of `key` in section `p`. Record a problem in `p` if the value is invalid. Throw
  // InputError only if `p` does, because its list of problems is full. If a scene lacks the key, the member
  // is set to the default, unless the default depends on the technique. If a request lacks the key, the
  // member is unchanged.
  void read_scene(Params& p, RenderSettings& settings) const;
  void read_request(Params& p, RenderSettings& settings) const;
};

// Returns all options, in the order of schema and help.
std::span<const RenderOption> render_options();

// Returns the default of every option for the default technique.
const RenderSettings& default_settings();

// Read all options of a section; read_scene_options() only options with `in_scene`. Errors are those of
// RenderOption::read_scene() and read_request(). No other code checks the ranges of options.
void read_scene_options(Params& p, Section section, RenderSettings& settings);
void read_request_options(Params& p, Section section, RenderSettings& settings);

// Returns whether an error limit or a time limit above 0 is set.
bool has_budget(const RenderSettings& settings);
// Throws InputError if a budget is set. `what` names the output that does not support budgets, e.g. "a
// chart".
void require_no_budget(const RenderSettings& settings, std::string_view what);
// Throws InputError unless the view is `picture`. `what` names the output or option that supports no other
// view, e.g. "a chart".
void require_picture(const RenderSettings& settings, std::string_view what);

// Returns a value for every option: from the request, else from the scene, else the default. The time is
// clamped to the scene's motion. With a budget, samples, depth, precision and min_contribution are never
// taken from the scene. If the request omits them, samples and depth are set to their maximum, precision to
// double, and min_contribution to 0.001 for a time limit alone or to 1/16 for an error budget. An error
// budget may reduce this min_contribution during the render. Does not throw InputError.
RenderSettings resolve(const Scene& scene, const RenderSettings& asked);

// Returns the camera orbit. REQUIRES: the camera options are given.
Orbit orbit_of(const RenderSettings& settings);

// Returns the given options as JSON text of a request: {"camera": {...}, "image": {...}, "render": {...}}.
// Sections without options are omitted. Reading the text gives the same settings.
std::string to_json(const RenderSettings& settings);

// Returns a query string with the settings that change pixels and differ from the settings of a request that
// names only the technique: "max_depth=12&samples=16", or "". A request with this query renders an identical
// image. REQUIRES: all settings are given.
std::string query_of(const Scene& scene, const RenderSettings& settings);

}  // namespace orrery
