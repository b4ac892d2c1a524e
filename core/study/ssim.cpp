#include "core/study/ssim.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "core/image/srgb.h"

namespace orrery {
namespace {

using Plane = std::vector<double>;

// Computes Rec. 709 luma. Rec. 709 and sRGB have the same primaries.
Plane luma_of(std::span<const float> linear) {
  constexpr std::array kWeights{0.2126, 0.7152, 0.0722};
  Plane luma(linear.size() / 3);
  for (std::size_t i = 0; i < linear.size(); ++i)
    luma[i / 3] += kWeights[i % 3] * encode_srgb(std::isfinite(linear[i]) ? double{linear[i]} : 0);
  return luma;
}

constexpr int kReach = 5;  // pixels on each side of the centre
constexpr double kDeviation = 1.5;

// Returns the Gaussian weights of neighbours, by distance in pixels.
std::array<double, kReach + 1> weights_by_distance() {
  std::array<double, kReach + 1> weights;
  for (int i = 0; i <= kReach; ++i)
    weights[static_cast<std::size_t>(i)] = std::exp(-i * i / (2 * kDeviation * kDeviation));
  return weights;
}

// Computes weighted means along `lines` lines of `count` values each. The values of a line are `step` apart.
// Lines begin at multiples of `next`.
Plane smoothed_along(const Plane& plane, int count, std::size_t step, std::size_t lines, std::size_t next) {
  const auto by_distance = weights_by_distance();
  Plane smoothed(plane.size());
  for (std::size_t line = 0; line < lines; ++line) {
    for (int at = 0; at < count; ++at) {
      double sum = 0, weights = 0;
      for (int i = std::max(0, at - kReach); i <= std::min(count - 1, at + kReach); ++i) {
        const double weight = by_distance[static_cast<std::size_t>(std::abs(i - at))];
        sum += weight * plane[line * next + static_cast<std::size_t>(i) * step];
        weights += weight;
      }
      smoothed[line * next + static_cast<std::size_t>(at) * step] = sum / weights;
    }
  }
  return smoothed;
}

Plane smoothed(const Plane& plane, int width) {
  const auto columns = static_cast<std::size_t>(width), rows = plane.size() / columns;
  return smoothed_along(smoothed_along(plane, width, 1, rows, columns), static_cast<int>(rows), columns,
                        columns, 1);
}

Plane product(const Plane& a, const Plane& b) {
  Plane all(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) all[i] = a[i] * b[i];
  return all;
}

}  // namespace

double ssim(std::span<const float> picture, std::span<const float> reference, int width) {
  assert(picture.size() == reference.size() && picture.size() % (3 * static_cast<std::size_t>(width)) == 0);
  constexpr double kDark = 0.01 * 0.01, kFlat = 0.03 * 0.03;  // C1 and C2, for codes from 0 to 1
  const Plane x = luma_of(picture), y = luma_of(reference);
  const Plane mean_x = smoothed(x, width), mean_y = smoothed(y, width), xx = smoothed(product(x, x), width),
              yy = smoothed(product(y, y), width), xy = smoothed(product(x, y), width);
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double mx = mean_x[i], my = mean_y[i];
    const double variances = xx[i] - mx * mx + yy[i] - my * my, covariance = xy[i] - mx * my;
    sum += (2 * mx * my + kDark) * (2 * covariance + kFlat) /
           ((mx * mx + my * my + kDark) * (variances + kFlat));
  }
  return sum / static_cast<double>(x.size());
}

}  // namespace orrery
