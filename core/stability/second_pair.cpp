#include <cmath>

#include "core/math/sampling.h"
#include "core/stability/row.h"

namespace orrery {
namespace {

// Returns the RMS errors over pixels of an estimate of 1/4. The estimate is the fraction of samples for which
// the first numbers of two streams are both below 1/2.
StabilityFigures deviations(std::uint32_t samples) {
  constexpr std::uint32_t kPixels = 256;
  StabilityFigures squares{0, 0};
  for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel) {
    const std::uint32_t first = combine_bits(1, pixel), second = combine_bits(2, pixel);
    double known = 0, ours = 0;
    for (std::uint32_t i = 0; i < samples; ++i) {
      known += scrambled_point(i, first).u < 0.5f && scrambled_point(i, second).u < 0.5f;
      ours += stratified_point(i, first).u < 0.5f && stratified_point(i, second).u < 0.5f;
    }
    squares.known += (known / samples - 0.25) * (known / samples - 0.25) / kPixels;
    squares.ours += (ours / samples - 0.25) * (ours / samples - 0.25) / kPixels;
  }
  return {std::sqrt(squares.known), std::sqrt(squares.ours)};
}

StabilityFigures measure() {
  LineChart chart{"second-pair", "Two pairs of random numbers: estimate of 1/4", "samples", "RMS error", true,
                  true,          {{"same order", {}}, {"separate orders", {}}}};
  StabilityFigures figures{0, 0};
  for (std::uint32_t samples = 4; samples <= 1024; samples *= 2) {
    const StabilityFigures at = deviations(samples);
    chart.series[0].points.push_back({samples, at.known});
    chart.series[1].points.push_back({samples, at.ours});
    if (samples == 256) figures = at;
  }
  figures.chart = std::move(chart);
  return figures;
}

}  // namespace

StabilityRow second_pair_row() {
  return {"light-2",
          "Second pair of random numbers",
          "fraction of 256 samples whose random numbers for two purposes are both below 1/2: RMS error",
          "1",
          "scrambled nets in the same order for all pairs",
          0.2,
          "a separate order for each pair (Burley 2020)",
          0.03,
          measure};
}

}  // namespace orrery
