#include <algorithm>
#include <cmath>

#include "core/load/load.h"
#include "core/stability/pictures.h"
#include "core/stability/row.h"

namespace orrery {
namespace {

constexpr int kSide = 32, kSamples = 16;

// Scene that is white to the left of a slanted edge and black to the right.
constexpr const char* kEdge = R"({"version": 1, "ambient": [1, 1, 1],
  "camera": {"type": "orthographic", "eye": [0, 0, 5], "look_at": [0, 0, 0], "height": 32},
  "materials": {"m": {"type": "rough", "ka": 1, "kd": 0}},
  "objects": [{"type": "triangle", "vertices": [[-18.7, -100, 0], [18.7, 100, 0], [-1000, 0, 0]], "material": "m"}]})";

double rms(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

RenderRequest request_of(int samples, std::uint64_t seed) {
  RenderRequest request;
  request.width = request.height = kSide;
  request.technique = "raycast";
  request.samples = samples;
  request.seed = seed;
  return request;
}

std::vector<double> means_of(const TileSums& sums) {
  std::vector<double> means;
  for (int i = 0; i < kSide * kSide; ++i)
    means.push_back(sums.radiance[0][static_cast<std::size_t>(i)] / sums.samples);
  return means;
}

// Returns, for each pixel, half of the difference between the mean of the samples with even numbers and the
// mean of the samples with odd numbers.
std::vector<double> even_odd_differences(SampledTile& tile) {
  std::vector<double> differences(kSide * kSide), before(kSide * kSide);
  for (int sample = 0; sample < kSamples; ++sample) {
    const TileSums& sums = tile.add(1);
    for (std::size_t i = 0; i < differences.size(); ++i) {
      const double value = sums.radiance[0][i] - before[i];
      differences[i] += (sample % 2 == 0 ? value : -value) / kSamples;
      before[i] = sums.radiance[0][i];
    }
  }
  return differences;
}

double factor_between(double a, double b) { return std::max(a / b, b / a); }

StabilityFigures measure() {
  const auto scene = load_scene(kEdge);
  const std::vector<double> exact = means_of(SampledTile(scene, request_of(4096, 4711)).add(4096));
  SampledTile at_once(scene, request_of(kSamples, 0)), one_by_one(scene, request_of(kSamples, 0));
  std::vector<double> error = means_of(at_once.add(kSamples));
  for (std::size_t i = 0; i < error.size(); ++i) error[i] -= exact[i];
  const double realised = rms(error);
  return {factor_between(rms(even_odd_differences(one_by_one)), realised),
          factor_between(at_once.error().pixel.rmse(), realised)};
}

}  // namespace

StabilityRow halves_row() {
  return {
      "certificate-18",
      "Error estimate from sample halves",
      "RMS error of an image of an edge, estimated from its 16 samples per pixel: factor between estimate "
      "and true error",
      "1",
      "samples with even numbers compared with samples with odd numbers (Dammertz and others 2010)",
      4,
      "first half of the samples compared with the second half; both halves are low-discrepancy nets",
      1.6,
      measure};
}

}  // namespace orrery
