#include <cmath>

#include "core/load/load.h"
#include "core/stability/pictures.h"
#include "core/stability/row.h"

namespace orrery {
namespace {

// Scene with a constant background. The only object is a ball behind the camera.
constexpr const char* kSky = R"({"version": 1, "background": [0.1, 0.1, 0.1],
  "camera": {"type": "perspective", "eye": [0, 0, 4], "look_at": [0, 0, 0]}, "materials": {"m": {"type": "rough"}},
  "objects": [{"type": "sphere", "center": [0, 0, 900], "radius": 1, "material": "m"}]})";
constexpr int kSamples = 1024;

StabilityFigures measure() {
  float sum = 0;
  for (int i = 0; i < kSamples; ++i) sum += 0.1f;
  const double in_float = static_cast<double>(sum) / kSamples / static_cast<double>(0.1f);

  RenderRequest request;
  request.width = request.height = 1;
  request.technique = "path";
  request.precision = Precision::double_precision;
  request.samples = kSamples;
  SampledTile pixel(load_scene(kSky), request);
  const double of_film = pixel.add(kSamples).radiance[0][0] / kSamples / 0.1;
  return {std::abs(in_float - 1), std::abs(of_film - 1)};
}

}  // namespace

StabilityRow accumulation_row() {
  return {"A34",
          "Sums of samples",
          "mean of 1,024 samples of radiance 0.1: relative error",
          "1",
          "one running sum in float",
          1e-6,
          "sums in double, as in the film",
          1e-12,
          measure};
}

}  // namespace orrery
