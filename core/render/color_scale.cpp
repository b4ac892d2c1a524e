#include "core/render/color_scale.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/image/srgb.h"

namespace orrery {

Vec3d color_of_error(double error) {
  constexpr double kStart = 0.5, kTurns = -1.5, kHue = 1;
  if (std::isnan(error)) error = kWhiteError;
  const double along = std::log(std::clamp(error, kBlackError, kWhiteError) / kBlackError) /
                       std::log(kWhiteError / kBlackError);
  const double angle = 2 * std::numbers::pi * (kStart / 3 + 1 + kTurns * along);
  const double reach = kHue * along * (1 - along) / 2, c = std::cos(angle), s = std::sin(angle);
  const auto linear = [&](double of_cosine, double of_sine) {
    const double shown = std::clamp(along + reach * (of_cosine * c + of_sine * s), 0.0, 1.0);
    return double{decode_srgb(static_cast<float>(shown))};
  };
  return {linear(-0.14861, 1.78277), linear(-0.29227, -0.90649), linear(1.97294, 0)};
}

}  // namespace orrery
