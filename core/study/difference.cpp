#include "core/study/difference.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace orrery {

Difference difference(std::span<const float> picture, std::span<const float> reference) {
  assert(picture.size() == reference.size());
  constexpr double kDark = 0.01;
  Difference found;
  double squares = 0, relative = 0, absolute = 0, sum = 0, cut_squares = 0;
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const double x = picture[i], r = reference[i];
    if (!std::isfinite(x) || !std::isfinite(r)) {
      ++found.non_finite;
      continue;
    }
    const double d = x - r, cut = std::clamp(x, 0.0, 1.0) - std::clamp(r, 0.0, 1.0);
    squares += d * d;
    relative += d * d / ((r + kDark) * (r + kDark));
    absolute += std::fabs(d);
    sum += d;
    cut_squares += cut * cut;
    found.largest = std::max(found.largest, std::fabs(d));
  }
  const double count = std::max(1.0, double(picture.size()) - double(found.non_finite));
  found.rmse = std::sqrt(squares / count);
  found.relative_mse = relative / count;
  found.mean_absolute = absolute / count;
  found.bias = sum / count;
  found.cut_mse = cut_squares / count;
  return found;
}

}  // namespace orrery
