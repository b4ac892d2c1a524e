#include <cmath>

#include "core/load/load.h"
#include "core/stability/pictures.h"
#include "core/stability/row.h"
#include "core/stability/split_mix.h"
#include "core/study/svg.h"

namespace orrery {
namespace {

constexpr int kSide = 32;
// Fraction of a pixel's area that its dot covers, and the error limit of both methods.
constexpr double kShare = 0.01, kError = 0.01;

// Returns a scene with a white dot at a random position in each pixel, over 1 % of the pixel's area.
std::shared_ptr<const Scene> dots() {
  SplitMix random(1);
  const double radius = std::sqrt(kShare / 3.14159265358979324);
  std::string objects;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      objects +=
          printed(R"(%s{"type": "sphere", "center": [%.6f, %.6f, 0], "radius": %.9f, "material": "m"})",
                  objects.empty() ? "" : ",", x - kSide / 2 + random.between(0.1, 0.9),
                  y - kSide / 2 + random.between(0.1, 0.9), radius);
  return load_scene(printed(R"({"version": 1, "ambient": [1, 1, 1],
      "materials": {"m": {"type": "rough", "ka": 1, "kd": 0}},
      "camera": {"type": "orthographic", "eye": [0, 0, 5], "look_at": [0, 0, 0], "height": %d}, "objects": [)",
                            kSide) +
                    objects + "]}");
}

RenderRequest request_of() {
  RenderRequest request;
  request.width = request.height = kSide;
  request.technique = "raycast";
  return request;
}

// Returns the mean of an image with a separate sample count per pixel. A pixel stops after 4, 8, 16, ... or
// 512 samples, once the mean of its samples differs from the mean of their first half by at most kError.
double mean_by_pixels(const std::shared_ptr<const Scene>& scene) {
  constexpr int kMost = 512;
  RenderRequest request = request_of();
  request.samples = kMost;
  SampledTile tile(scene, request);
  constexpr std::size_t kPixels = kSide * kSide;
  std::vector<double> half(kPixels), found(kPixels, -1);
  for (int samples = 2; samples <= kMost; samples *= 2) {
    const TileSums& sums = tile.add(samples == 2 ? 2 : samples / 2);
    for (std::size_t i = 0; i < kPixels; ++i) {
      const double mean = sums.radiance[0][i] / samples;
      const bool ends = samples >= 4 && std::abs(mean - half[i]) <= kError;
      if (found[i] < 0 && (ends || samples == kMost)) found[i] = mean;
      half[i] = mean;
    }
  }
  double sum = 0;
  for (const double value : found) sum += value;
  return sum / kPixels;
}

double mean_by_picture(const std::shared_ptr<const Scene>& scene) {
  RenderRequest request = request_of();
  request.error = kError;
  request.space = Space::linear;
  const std::vector<float> values = values_of(rendered(scene, request).film);
  double sum = 0;
  for (const float value : values) sum += static_cast<double>(value);
  return sum / static_cast<double>(values.size());
}

StabilityFigures measure() {
  const auto scene = dots();
  return {100 * std::abs(mean_by_pixels(scene) / kShare - 1),
          100 * std::abs(mean_by_picture(scene) / kShare - 1)};
}

}  // namespace

StabilityRow rare_feature_row() {
  return {"E20",
          "Features that few samples hit",
          "image of 1,024 pixels, each with a dot over 1 % of its area, rendered to an error of 0.01: "
          "relative error of the "
          "mean",
          "%",
          "separate sample count per pixel: a pixel stops once both halves of its samples agree",
          70,
          "one sample count for the image, chosen from the sample halves of all pixels",
          3,
          measure};
}

}  // namespace orrery
