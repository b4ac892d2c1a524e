#include "core/environments/light_map.h"

#include <algorithm>

#include "core/base/task_scope.h"

namespace orrery {
namespace {

double luminance(const float* rgb) {  // ITU-R BT.709
  return 0.2126 * double{rgb[0]} + 0.7152 * double{rgb[1]} + 0.0722 * double{rgb[2]};
}

// Returns the sine of the angle from +y to the middle of a row.
double sine_of(int row, int height) { return sine_cosine_turns((row + 0.5) / (2 * height)).sine; }

std::vector<float> weights_of(const Texels& picture, LightMap::Weights weights) {
  constexpr double kLeast = 1e-6;  // up to this fraction of light above the mean, light counts as uniform
  const auto width = static_cast<std::size_t>(picture.width);
  double light = 0, sines = 0;
  const auto for_each_row = [&](const auto& visit) {
    for (int row = 0; row < picture.height; ++row) {
      checkpoint();
      visit(picture.rgb.data() + static_cast<std::size_t>(row) * width * 3, sine_of(row, picture.height));
    }
  };
  for_each_row([&](const float* rgb, double sine) {
    double of_row = 0;
    for (std::size_t i = 0; i < width; ++i) of_row += luminance(rgb + 3 * i);
    light += of_row * sine;
    sines += static_cast<double>(width) * sine;
  });
  const double mean = weights == LightMap::Weights::compensated ? light / sines : 0;
  std::vector<float> all;
  all.reserve(picture.rgb.size() / 3);
  double above = 0;
  for_each_row([&](const float* rgb, double sine) {
    for (std::size_t i = 0; i < width; ++i) {
      const double weight = std::max(0.0, luminance(rgb + 3 * i) - mean) * sine;
      above += weight;
      all.push_back(static_cast<float>(weight));
    }
  });
  if (above <= kLeast * light) std::fill(all.begin(), all.end(), 0.0f);
  return all;
}

}  // namespace

LightMap::LightMap(const Texels& picture, Weights weights)
    : table_(picture.width, picture.height, weights_of(picture, weights)) {
  texels_.reserve(picture.rgb.size() / 3);
  const float* rgb = picture.rgb.data();
  for (int row = 0; row < picture.height; ++row) {
    checkpoint();
    for (int column = 0; column < picture.width; ++column, rgb += 3)
      texels_.push_back(
          {rgb[0], rgb[1], rgb[2], sampled() ? static_cast<float>(table_.probability({column, row})) : 0.0f});
  }
}

Vec3d LightMap::most() const {
  Vec3d most(0);
  for (const Texel& texel : texels_)
    most = largest(most, Vec3d(double{texel.red}, double{texel.green}, double{texel.blue}));
  return most;
}

}  // namespace orrery
