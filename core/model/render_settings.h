#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/vec3.h"

namespace orrery {

// Number type of rays, and the names of the types.
enum class Precision { automatic, single_precision, double_precision };
inline constexpr std::array<std::string_view, 3> kPrecisions{"auto", "float", "double"};

// Who proposes what may stand in a shadow ray's way, before the accelerator is asked; and their names.
enum class Prediction { none, network, last, random };
inline constexpr std::array<std::string_view, 4> kPredictions{"none", "network", "last", "random"};
inline constexpr std::string_view name_of(Prediction prediction) {
  return kPredictions[static_cast<std::size_t>(prediction)];
}

// What the samples of a pixel are weighted by, and the names.
enum class Filter { box, gaussian, blackman_harris, mitchell, lanczos };
inline constexpr std::array<std::string_view, 5> kFilters{"box", "gaussian", "blackman-harris", "mitchell",
                                                          "lanczos"};
inline constexpr std::string_view name_of(Filter filter) {
  return kFilters[static_cast<std::size_t>(filter)];
}

// What errors are measured in, and the names: radiance, or what a screen shows of it, sRGB-encoded from 0 to
// 1; automatic is what the file's format keeps.
enum class Space { automatic, linear, display };
inline constexpr std::array<std::string_view, 3> kSpaces{"auto", "linear", "display"};
inline constexpr std::string_view name_of(Space space) { return kSpaces[static_cast<std::size_t>(space)]; }

// What becomes of a picture that misses its budget, and the names: the best that was made, or an error.
enum class OnMiss { best, fail };
inline constexpr std::array<std::string_view, 2> kOnMisses{"best", "fail"};

// What is shown, and the names: the picture, or how far each of its pixels may be off.
enum class View { picture, bound };
inline constexpr std::array<std::string_view, 2> kViews{"picture", "bound"};

// Values of the render options, one member an option. The table in core/plan/options.h gives each its name,
// range and default. A member without a value was not given.
struct RenderSettings {
  std::optional<double> azimuth_degrees, elevation_degrees, distance;  // the camera's place; see Orbit
  std::optional<Vec3d> pan;                                            // metres
  std::optional<double> fov_degrees;
  std::optional<int> width, height;  // pixels
  std::optional<std::string> technique;
  std::optional<int> max_depth;
  std::optional<double> min_contribution;
  std::optional<int> samples;  // a pixel
  std::optional<Filter> filter;
  std::optional<double> filter_width;    // pixels
  std::optional<int> reuse;              // paths in a group
  std::optional<double> clamp_indirect;  // radiance; 0: none
  std::optional<std::string> accelerator;
  std::optional<Precision> precision;
  std::optional<std::uint64_t> seed;
  std::optional<bool> reorder;
  std::optional<Prediction> prediction;
  std::optional<double> time, shutter;             // seconds
  std::optional<std::vector<std::string>> layers;  // film channels beside radiance
  std::optional<View> view;
  // Budgets of one picture. Errors are root-mean-square; 0: none.
  std::optional<double> error, seconds;
  std::optional<Space> space;
  std::optional<OnMiss> on_miss;

  bool operator==(const RenderSettings&) const = default;
};

}  // namespace orrery
