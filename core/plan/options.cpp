#include "core/plan/options.h"

#include <algorithm>
#include <functional>

#include "core/accelerators/registry.h"
#include "core/base/error.h"
#include "core/channels/registry.h"
#include "core/model/scene.h"
#include "core/model/technique.h"
#include "core/params/motion.h"
#include "core/plan/limits.h"
#include "core/techniques/registry.h"

namespace orrery {
namespace {

using O = RenderOption;
using S = RenderSettings;

template <class Types>
O::Names names_of(const Types& types) {
  O::Names names;
  for (const auto& type : types) names.push_back(type.name);
  return names;
}
int max_depth_of(const TechniqueType& type) { return type.max_depth; }
O::Names technique_names() { return names_of(technique_types()); }
O::Names channel_names() { return names_of(channel_types()); }
// Returns "auto", which lets the planner choose, followed by the names of the accelerators.
O::Names accelerator_names() {
  O::Names names = names_of(accelerator_types());
  names.insert(names.begin(), "auto");
  return names;
}

static_assert(std::int64_t{kMaxImageSide} * kMaxImageSide <= kMaxImagePixels,
              "an image whose sides are in range has at most kMaxImagePixels pixels");

// All options, in the order of the schema and of help.
constexpr std::array kOptions{
    O{.key = "azimuth_degrees",
      .short_name = "azimuth",
      .section = Section::camera,
      .kind = O::Number{&S::azimuth_degrees, {.min = -kMaxOrbitDegrees, .max = kMaxOrbitDegrees}, 0},
      .placeholder = "DEGREES",
      .help = "Camera azimuth in degrees from the scene's camera, anticlockwise as seen from above.",
      .in_scene = false},
    O{.key = "elevation_degrees",
      .short_name = "elevation",
      .section = Section::camera,
      .kind = O::Number{&S::elevation_degrees, {.min = -180, .max = 180}, 0},
      .placeholder = "DEGREES",
      .help = "Camera elevation in degrees above the scene's camera, clamped directly above and below the "
              "target.",
      .in_scene = false},
    O{.key = "distance",
      .section = Section::camera,
      .kind = O::Number{&S::distance, {.min = kMinOrbitDistance, .max = kMaxOrbitDistance}, 1},
      .placeholder = "FACTOR",
      .help = "Camera distance from its target, as a multiple of the distance in the scene.",
      .in_scene = false},
    O{.key = "pan",
      .section = Section::camera,
      .kind = O::Point{&S::pan},
      .placeholder = "X,Y,Z",
      .help = "Translation of the camera and its target, in metres.",
      .in_scene = false},
    O{.key = "fov_degrees",
      .short_name = "fov",
      .section = Section::camera,
      .kind =
          O::Number{
              &S::fov_degrees, {.min = 0, .max = 180, .exclusive_min = true, .exclusive_max = true}, 45},
      .placeholder = "DEGREES",
      .help = "Vertical field of view in degrees, for any aspect ratio."},
    O{.key = "width",
      .section = Section::image,
      .kind = O::Integer<int>{&S::width, 1, kMaxImageSide, 600},
      .placeholder = "PIXELS",
      .help = "Image width in pixels."},
    O{.key = "height",
      .section = Section::image,
      .kind = O::Integer<int>{&S::height, 1, kMaxImageSide, 600},
      .placeholder = "PIXELS",
      .help = "Image height in pixels."},
    O{.key = "technique",
      .section = Section::render,
      .kind = O::Name{&S::technique, technique_names, "whitted"},
      .placeholder = "NAME",
      .help = "Light transport algorithm."},
    O{.key = "max_depth",
      .short_name = "depth",
      .section = Section::render,
      .kind = O::Integer<int>{&S::max_depth, 0, kMaxDepth, 5},
      .placeholder = "N",
      .help = "Maximum ray depth; camera rays have depth 0. Default: 5; distributed 6; path 9.",
      .by_technique = max_depth_of},
    O{.key = "min_contribution",
      .section = Section::render,
      .kind = O::Number{&S::min_contribution, {.min = 0, .max = 1}, 0},
      .placeholder = "WEIGHT",
      .help = "Minimum ray weight; rays below it in every channel are not traced."},
    O{.key = "samples",
      .section = Section::render,
      .kind = O::Integer<int>{&S::samples, 1, kMaxSamples, 1},
      .placeholder = "N",
      .help = "Samples per pixel; one is at the pixel centre, more are stratified."},
    O{.key = "filter",
      .section = Section::render,
      .kind = O::Enumeration<Filter>{&S::filter, kFilters},
      .help = "Pixel reconstruction filter."},
    O{.key = "filter_width",
      .section = Section::render,
      .kind = O::Number{&S::filter_width, {.min = 0, .max = 16}, 0},
      .placeholder = "PIXELS",
      .help = "Filter width in pixels; 0: the default width of the filter."},
    O{.key = "path_reuse",
      .short_name = "reuse",
      .section = Section::render,
      .kind = O::Integer<int>{&S::reuse, 1, kMaxReuse, 16},
      .placeholder = "N",
      .help = "Maximum path-reuse group size, rounded down to a power of two; 1 disables reuse."},
    O{.key = "clamp_indirect",
      .section = Section::render,
      .kind = O::Number{&S::clamp_indirect, {.min = 0, .max = kMaxColor}, 0},
      .placeholder = "RADIANCE",
      .help = "Limit of a sample's indirect radiance per channel, reported as a bias; 0: no limit."},
    O{.key = "tessellation_error",
      .section = Section::render,
      .kind = O::Number{&S::tessellation_error, {.min = kMinTessellationError, .max = 64}, 0.25},
      .placeholder = "PIXELS",
      .help =
          "Largest distance of the triangles of flat, gouraud and phong from curved surfaces, in pixels."},
    O{.key = "interpolation",
      .section = Section::render,
      .kind = O::Enumeration<Interpolation>{&S::interpolation, kInterpolations},
      .help = "Interpolation within a triangle of gouraud and phong: linear in the scene, or in the image."},
    O{.key = "accelerator",
      .section = Section::render,
      .kind = O::Name{&S::accelerator, accelerator_names, "auto"},
      .placeholder = "NAME",
      .help = "Acceleration structure.",
      .changes_pixels = false},
    O{.key = "precision",
      .section = Section::render,
      .kind = O::Enumeration<Precision>{&S::precision, kPrecisions},
      .help = "Number type of rays; auto: float if it is accurate enough, else double."},
    O{.key = "seed",
      .section = Section::render,
      .kind = O::Integer<std::uint64_t>{&S::seed, 0, kMaxSeed, 0},
      .placeholder = "N",
      .help = "Seed of all random numbers."},
    O{.key = "ray_sorting",
      .short_name = "reorder",
      .section = Section::render,
      .kind = O::Flag{&S::reorder, false},
      .help = "Sort rays by origin and direction before traversal.",
      .changes_pixels = false},
    O{.key = "energy",
      .section = Section::render,
      .kind = O::Flag{&S::energy, false},
      .help = "Count the light that each material reflects, transmits and absorbs.",
      .changes_pixels = false},
    O{.key = "occluder_prediction",
      .short_name = "prediction",
      .section = Section::render,
      .kind = O::Enumeration<Prediction>{&S::prediction, kPredictions},
      .help = "Occluder predictor used before shadow-ray traversal.",
      .changes_pixels = false},
    O{.key = "time",
      .section = Section::render,
      .kind = O::Number{&S::time, {.min = -kMaxTime, .max = kMaxTime}, 0},
      .placeholder = "SECONDS",
      .help = "Scene time in seconds, at which the shutter opens."},
    O{.key = "shutter",
      .section = Section::render,
      .kind = O::Number{&S::shutter, {.min = 0, .max = kMaxTime}, 0},
      .placeholder = "SECONDS",
      .help = "Exposure time in seconds; 0: an instant."},
    O{.key = "layers",
      .section = Section::render,
      .kind = O::NameList{&S::layers, channel_names},
      .placeholder = "NAMES",
      .help = "Additional EXR channels: properties of the first hits of camera rays."},
    O{.key = "view",
      .section = Section::render,
      .kind = O::Enumeration<View>{&S::view, kViews},
      .help = "Output: the image, or the error bound of each pixel as a colour. The bound is the light of "
              "untraced rays plus half the difference between the means of the two halves of the samples.",
      .in_scene = false},
    O{.key = "max_error",
      .short_name = "error",
      .section = Section::budget,
      .kind = O::Number{&S::error, {.min = 0, .max = 1}, 0},
      .placeholder = "RMS",
      .help = "Maximum RMS error (error budget); 0: none. Samples, depth, minimum contribution and precision "
              "are chosen automatically unless set.",
      .in_scene = false},
    O{.key = "error_metric",
      .short_name = "space",
      .section = Section::budget,
      .kind = O::Enumeration<Space>{&S::space, kSpaces},
      .help = "Error metric: linear radiance, or display (sRGB, 0-1); auto: display for 8-bit files with a "
              "budget, else linear.",
      .in_scene = false},
    O{.key = "time_limit_seconds",
      .short_name = "seconds",
      .section = Section::budget,
      .kind = O::Number{&S::seconds, {.min = 0, .max = kMaxBudgetSeconds}, 0},
      .placeholder = "SECONDS",
      .help = "Time limit in seconds for the whole response (orbit: for the first frame); 0: none. Samples, "
              "depth and precision are chosen automatically unless set.",
      .in_scene = false},
    O{.key = "on_budget_miss",
      .short_name = "on_miss",
      .section = Section::budget,
      .kind = O::Enumeration<OnMiss>{&S::on_miss, kOnMisses},
      .help = "Result of a missed budget: the best image so far, or an error.",
      .in_scene = false,
      .changes_pixels = false},
};

// Returns the default value of an option.
template <class I>
I fallback_of(const O::Integer<I>& kind) {
  return static_cast<I>(kind.fallback);
}
double fallback_of(const O::Number& kind) { return kind.fallback; }
bool fallback_of(const O::Flag& kind) { return kind.fallback; }
Vec3d fallback_of(const O::Point&) { return Vec3d(0); }
std::string fallback_of(const O::Name& kind) { return kind.fallback; }
template <class E>
E fallback_of(const O::Enumeration<E>&) {
  return E{};
}
std::vector<std::string> fallback_of(const O::NameList&) { return {}; }

template <class V>
Fallback<V> missing(const V& fallback, bool in_schema) {
  return in_schema ? Fallback<V>(fallback) : derived(fallback);
}

// Reads the value of the option's key. Returns the default if the key is missing. The schema shows the
// default if `in_schema` is true.
template <class I>
I read(Params& p, const O& o, const O::Integer<I>& kind, bool in_schema) {
  return static_cast<I>(p.integer(o.key, o.help, kind.min, kind.max, missing(kind.fallback, in_schema)));
}
double read(Params& p, const O& o, const O::Number& kind, bool in_schema) {
  return p.number(o.key, o.help, kind.range, missing(kind.fallback, in_schema));
}
bool read(Params& p, const O& o, const O::Flag& kind, bool in_schema) {
  return p.flag(o.key, o.help, missing(kind.fallback, in_schema));
}
Vec3d read(Params& p, const O& o, const O::Point& kind, bool in_schema) {
  return p.point(o.key, o.help, missing(fallback_of(kind), in_schema));
}
std::string read(Params& p, const O& o, const O::Name& kind, bool in_schema) {
  return p.choice(o.key, o.help, kind.names(), missing<std::string_view>(kind.fallback, in_schema));
}
template <class E>
E read(Params& p, const O& o, const O::Enumeration<E>& kind, bool in_schema) {
  const std::string name = p.choice(o.key, o.help, kind.names, missing(kind.names.front(), in_schema));
  return E(std::find(kind.names.begin(), kind.names.end(), name) - kind.names.begin());
}
std::vector<std::string> read(Params& p, const O& o, const O::NameList& kind, bool) {
  return p.choices(o.key, o.help, kind.names());
}

// Formats a value as JSON text. Names in registries need no escapes.
std::string json_string(std::string_view name) { return "\"" + std::string(name) + "\""; }
std::string list_of(std::span<const std::string> parts) {
  std::string text = "[";
  for (const std::string& part : parts) text += (text.size() > 1 ? "," : "") + part;
  return text + "]";
}
template <class I>
std::string text_of(const O::Integer<I>&, I value) {
  return std::to_string(value);
}
std::string text_of(const O::Number&, double value) { return number_text(value + 0.0); }  // turns -0 into 0
std::string text_of(const O::Flag&, bool value) { return value ? "true" : "false"; }
std::string text_of(const O::Point&, const Vec3d& v) {
  return list_of(std::array{number_text(v.x + 0.0), number_text(v.y + 0.0), number_text(v.z + 0.0)});
}
std::string text_of(const O::Name&, const std::string& value) { return json_string(value); }
template <class E>
std::string text_of(const O::Enumeration<E>& kind, E value) {
  return json_string(kind.names[static_cast<std::size_t>(value)]);
}
std::string text_of(const O::NameList&, std::vector<std::string> values) {
  for (std::string& value : values) value = json_string(value);
  return list_of(values);
}

O::Names choices_of(const O::Name& kind) { return kind.names(); }
O::Names choices_of(const O::NameList& kind) { return kind.names(); }
template <class E>
O::Names choices_of(const O::Enumeration<E>& kind) {
  return {kind.names.begin(), kind.names.end()};
}
O::Names choices_of(const O::Flag&) { return {"true", "false"}; }
O::Names choices_of(const auto&) { return {}; }

template <class I>
constexpr O::Form form_of(const O::Integer<I>&) {
  return O::Form::number;
}
constexpr O::Form form_of(const O::Number&) { return O::Form::number; }
constexpr O::Form form_of(const O::Flag&) { return O::Form::boolean; }
constexpr O::Form form_of(const O::Point&) { return O::Form::numbers; }
constexpr O::Form form_of(const O::NameList&) { return O::Form::strings; }
constexpr O::Form form_of(const auto&) { return O::Form::string; }

}  // namespace

std::string_view name_of(Section section) {
  constexpr std::array<std::string_view, kSections.size()> kNames{"camera", "image", "render", "budget"};
  return kNames[static_cast<std::size_t>(section)];
}

std::string RenderOption::pointer() const {
  return "/" + std::string(name_of(section)) + "/" + std::string(key);
}

std::string RenderOption::value_name() const {
  if (!placeholder.empty()) return std::string(placeholder);
  std::string text;
  for (const std::string_view choice : choices()) text += (text.empty() ? "" : "|") + std::string(choice);
  return text;
}

RenderOption::Names RenderOption::choices() const {
  return std::visit([](const auto& of) { return choices_of(of); }, kind);
}

RenderOption::Form RenderOption::form() const {
  return std::visit([](const auto& of) { return form_of(of); }, kind);
}

bool RenderOption::given(const RenderSettings& settings) const {
  return std::visit([&](const auto& of) { return (settings.*of.member).has_value(); }, kind);
}

void RenderOption::copy(const RenderSettings& from, RenderSettings& to) const {
  std::visit([&](const auto& of) { to.*of.member = from.*of.member; }, kind);
}

std::string RenderOption::text(const RenderSettings& settings) const {
  return std::visit([&](const auto& of) { return text_of(of, *(settings.*of.member)); }, kind);
}

std::span<const RenderOption> render_options() { return kOptions; }

const RenderSettings& default_settings() {
  static const RenderSettings defaults = [] {
    RenderSettings all;
    for (const RenderOption& option : kOptions)
      std::visit([&](const auto& of) { all.*of.member = fallback_of(of); }, option.kind);
    return all;
  }();
  return defaults;
}

void RenderOption::read_scene(Params& p, RenderSettings& settings) const {
  std::visit(
      [&](const auto& of) {
        auto value = read(p, *this, of, !by_technique);
        if (p.has(key) || !by_technique) settings.*of.member = std::move(value);
      },
      kind);
}

void RenderOption::read_request(Params& p, RenderSettings& settings) const {
  std::visit(
      [&](const auto& of) {
        auto value = read(p, *this, of, !in_scene);
        if (p.has(key)) settings.*of.member = std::move(value);
      },
      kind);
}

void read_scene_options(Params& p, Section section, RenderSettings& settings) {
  for (const RenderOption& option : kOptions)
    if (option.section == section && option.in_scene) option.read_scene(p, settings);
}

void read_request_options(Params& p, Section section, RenderSettings& settings) {
  for (const RenderOption& option : kOptions)
    if (option.section == section) option.read_request(p, settings);
}

namespace {

// Returns the default of every option for the technique, or for the default technique if `technique` is
// nullopt.
RenderSettings defaults_of(const std::optional<std::string>& technique) {
  RenderSettings defaults = default_settings();
  for (const TechniqueType& type : technique_types())
    if (technique == type.name)
      for (const RenderOption& option : kOptions)
        if (option.by_technique) {
          const auto& integer = std::get<O::Integer<int>>(option.kind);
          defaults.*integer.member = option.by_technique(type);
        }
  return defaults;
}

}  // namespace

bool has_budget(const RenderSettings& settings) {
  return settings.error.value_or(0) > 0 || settings.seconds.value_or(0) > 0;
}

void require_no_budget(const RenderSettings& settings, std::string_view what) {
  if (has_budget(settings))
    throw InputError(settings.error.value_or(0) > 0 ? "/budget/max_error" : "/budget/time_limit_seconds",
                     "cannot be used with " + std::string(what) + " (a budget applies to one image)");
}

void require_picture(const RenderSettings& settings, std::string_view what) {
  if (settings.view.value_or(View::picture) != View::picture)
    throw InputError("/render/view", "must be \"picture\" with " + std::string(what) + " (got \"bound\")");
}

namespace {

// Initial min_contribution with an error budget. It is the same for all error limits, so that a smaller limit
// never leads to a larger value.
constexpr double kMaxContribution = 1.0 / 16;
// min_contribution with a time limit alone: a quarter of an 8-bit code. It limits ray trees, because a time
// limit sets the depth to its maximum. Compared with the default depth, mirrors take hardly more rays, and
// glass, whose rays branch, takes fewer.
constexpr double kTimedContribution = 0.001;

// Sets the options that a budget chooses, unless they are set.
void free_for_budget(RenderSettings& settings) {
  if (!settings.samples) settings.samples = kMaxSamples;
  if (!settings.max_depth) settings.max_depth = kMaxDepth;
  if (!settings.min_contribution)
    settings.min_contribution = settings.error.value_or(0) > 0 ? kMaxContribution : kTimedContribution;
  if (!settings.precision) settings.precision = Precision::double_precision;
}

}  // namespace

RenderSettings resolve(const Scene& scene, const RenderSettings& asked) {
  RenderSettings all = asked;
  if (has_budget(all)) free_for_budget(all);
  const auto complete = [&](const RenderSettings& otherwise) {
    for (const RenderOption& option : kOptions)
      if (!option.given(all)) option.copy(otherwise, all);
  };
  complete(scene.render);
  complete(defaults_of(all.technique));
  all.time = scene.motion.moment(*all.time, *all.shutter);
  return all;
}

Orbit orbit_of(const RenderSettings& settings) {
  return {*settings.azimuth_degrees, *settings.elevation_degrees, *settings.distance, *settings.pan};
}

std::string to_json(const RenderSettings& settings) {
  std::string text;
  for (const Section section : kSections) {
    std::string members;
    for (const RenderOption& option : kOptions)
      if (option.section == section && option.given(settings))
        members += (members.empty() ? "" : ",") + json_string(option.key) + ":" + option.text(settings);
    if (members.empty()) continue;
    text += (text.empty() ? "" : ",") + json_string(name_of(section)) + ":{" + members + "}";
  }
  return "{" + text + "}";
}

std::string query_of(const Scene& scene, const RenderSettings& settings) {
  RenderSettings technique;
  technique.technique = settings.technique;
  const RenderSettings usual = resolve(scene, technique), default_technique = resolve(scene, {});
  std::string query;
  for (const RenderOption& option : render_options()) {
    if (!option.changes_pixels) continue;
    const RenderSettings& otherwise = option.key == "technique" ? default_technique : usual;
    std::string text = option.text(settings);
    if (text == option.text(otherwise)) continue;
    std::erase_if(text, [](char c) { return c == '"' || c == '[' || c == ']'; });
    query += (query.empty() ? "" : "&") + std::string(option.key) + "=" + text;
  }
  return query;
}

}  // namespace orrery
