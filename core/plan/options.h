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

// The render options: one row of a table each. Reader and schema of scenes and requests, queries, flags,
// limits, the key and ETag of a picture, explain, statistics and OpenAPI are made from the rows.
namespace orrery {

struct Scene;
struct TechniqueType;

// The member of a request's JSON that an option stands in.
enum class Section { camera, image, render, budget };
inline constexpr std::array kSections{Section::camera, Section::image, Section::render, Section::budget};
std::string_view name_of(Section section);

struct RenderOption {
  template <class V>
  using Member = std::optional<V> RenderSettings::*;
  using Names = std::vector<std::string_view>;

  // The kinds of values: where the value is kept, what it may be, and the default.
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
  struct Name {  // one of a registry's
    Member<std::string> member;
    Names (*names)();
    const char* fallback;
  };
  template <class E>
  struct Enumeration {  // names[i] is the name of E(i); default: the first
    Member<E> member;
    std::span<const std::string_view> names;
  };
  struct NameList {  // distinct names of a registry; default: none
    Member<std::vector<std::string>> member;
    Names (*names)();
  };
  using Kind = std::variant<Integer<int>, Integer<std::uint64_t>, Number, Flag, Point, Name,
                            Enumeration<Precision>, Enumeration<Prediction>, Enumeration<Filter>,
                            Enumeration<Space>, Enumeration<OnMiss>, Enumeration<View>, NameList>;

  std::string_view key;  // the name: in JSON, in queries and, with hyphens after --, on command lines
  std::string_view short_name = {};  // also allowed in queries and on command lines; empty: none
  Section section;
  Kind kind;
  std::string_view placeholder = {};  // what help calls the value; empty: its choices, see value_name()
  std::string_view help;              // one sentence
  bool in_scene = true;               // a scene may give it too, and is then the default of a request
  bool changes_pixels = true;         // another value may give another picture
  // An integer's default where each technique has one of its own, which is in no schema then.
  int (*by_technique)(const TechniqueType&) = nullptr;

  std::string pointer() const;     // JSON Pointer in a request: "/camera/azimuth_degrees"
  std::string value_name() const;  // "DEGREES", "true|false"
  Names choices() const;           // the words that it may be; empty for other values

  // What a value is in JSON, for those who make JSON from text.
  enum class Form { number, boolean, string, numbers, strings };
  Form form() const;

  bool given(const RenderSettings& settings) const;
  void copy(const RenderSettings& from, RenderSettings& to) const;  // a missing value too
  // The value as JSON text; equal texts for equal values only. REQUIRES: given(settings).
  std::string text(const RenderSettings& settings) const;

  // Both check the value of `key` in the section `p`. In a scene, a missing one becomes the default, unless
  // that depends on the technique; in a request, it leaves the member alone.
  void read_scene(Params& p, RenderSettings& settings) const;
  void read_request(Params& p, RenderSettings& settings) const;
};

std::span<const RenderOption> render_options();

// Every option's default, with the default technique.
const RenderSettings& default_settings();

// Read a section: of a scene, only what scenes may give. Ranges are checked here and nowhere else.
void read_scene_options(Params& p, Section section, RenderSettings& settings);
void read_request_options(Params& p, Section section, RenderSettings& settings);

// Whether a picture is to be made until its error or its time is as asked.
bool has_budget(const RenderSettings& settings);
// Throws InputError if so, where `what` cannot keep any.
void require_no_budget(const RenderSettings& settings, std::string_view what);
// Throws InputError if another view is asked for, where `what` has the picture's alone.
void require_picture(const RenderSettings& settings, std::string_view what);

// Every option as asked or else as the scene says or else its default, the time held within the scene's
// motion. A budget frees what is not asked, whatever the scene says: of samples there may then be as many as
// any picture may have, rays may be as deep as any, those of trees with a least contribution of 1/16, of
// which an error makes less, or of 0.001 where only a time is given, in double precision.
RenderSettings resolve(const Scene& scene, const RenderSettings& asked);

// REQUIRES: the options of the camera are given.
Orbit orbit_of(const RenderSettings& settings);

// The options that are given, as JSON text of a request: {"camera": {...}, "image": {...}, "render": {...}}
// without empty members. Reading it gives the same settings.
std::string to_json(const RenderSettings& settings);

// A query that gives those of the settings, all of which are given, that the scene does not give itself and
// that change pixels: "max_depth=12&samples=16", or "". Its picture has the same bytes.
std::string query_of(const Scene& scene, const RenderSettings& settings);

}  // namespace orrery
