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

// Number type of rays, and the names of the choices.
enum class Precision { automatic, single_precision, double_precision };
inline constexpr std::array<std::string_view, 3> kPrecisions{"auto", "float", "double"};

// Predictor of occluders for shadow rays, used before traversal, and the names of the choices.
enum class Prediction { none, network, last, random };
inline constexpr std::array<std::string_view, 4> kPredictions{"none", "network", "last", "random"};
inline constexpr std::string_view name_of(Prediction prediction) {
  return kPredictions[static_cast<std::size_t>(prediction)];
}

// Reconstruction filter for the samples of a pixel, and the names of the choices.
enum class Filter { box, gaussian, blackman_harris, mitchell, lanczos };
inline constexpr std::array<std::string_view, 5> kFilters{"box", "gaussian", "blackman-harris", "mitchell",
                                                          "lanczos"};
inline constexpr std::string_view name_of(Filter filter) {
  return kFilters[static_cast<std::size_t>(filter)];
}

// Space in which errors are measured, and the names of the choices. linear: radiance. display: sRGB-encoded,
// 0 to 1. automatic: the space of the output format.
enum class Space { automatic, linear, display };
inline constexpr std::array<std::string_view, 3> kSpaces{"auto", "linear", "display"};
inline constexpr std::string_view name_of(Space space) { return kSpaces[static_cast<std::size_t>(space)]; }

// Result if a budget is missed, and the names of the choices. best: the best image reached. fail: an error.
enum class OnMiss { best, fail };
inline constexpr std::array<std::string_view, 2> kOnMisses{"best", "fail"};

// Output, and the names of the choices. picture: the image. bound: an error bound for each pixel.
enum class View { picture, bound };
inline constexpr std::array<std::string_view, 2> kViews{"picture", "bound"};

// Interpolation of scan line rendering, and the names of the choices. perspective: linear in the scene.
// screen: linear in the image.
enum class Interpolation { perspective, screen };
inline constexpr std::array<std::string_view, 2> kInterpolations{"perspective", "screen"};

// Values of the render options, one member per option. The table in core/plan/options.cpp defines names,
// ranges and defaults. An option that is not set is nullopt.
struct RenderSettings {
  std::optional<double> azimuth_degrees, elevation_degrees, distance;  // camera position; see Orbit
  std::optional<Vec3d> pan;                                            // metres
  std::optional<double> fov_degrees;
  std::optional<int> width, height;  // pixels
  std::optional<std::string> technique;
  std::optional<int> max_depth;
  std::optional<double> min_contribution;
  std::optional<int> samples;  // per pixel
  std::optional<Filter> filter;
  std::optional<double> filter_width;        // pixels
  std::optional<int> reuse;                  // maximum number of paths per group
  std::optional<double> clamp_indirect;      // radiance; 0: no limit
  std::optional<double> tessellation_error;  // pixels
  std::optional<Interpolation> interpolation;
  std::optional<std::string> accelerator;
  std::optional<Precision> precision;
  std::optional<std::uint64_t> seed;
  std::optional<bool> reorder;
  std::optional<bool> energy;
  std::optional<Prediction> prediction;
  std::optional<double> time, shutter;             // seconds
  std::optional<std::vector<std::string>> layers;  // film channels in addition to radiance
  std::optional<View> view;
  // Budgets of one image: root-mean-square error, and time in seconds. 0: no budget.
  std::optional<double> error, seconds;
  std::optional<Space> space;
  std::optional<OnMiss> on_miss;

  bool operator==(const RenderSettings&) const = default;
};

}  // namespace orrery
