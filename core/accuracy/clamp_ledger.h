#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "core/accuracy/omission_ledger.h"

namespace orrery {

// Ledger of Plan::clamp_indirect: radiance that the clamp removed from the samples. The mean is exact for
// these samples. The variation between tiles gives the standard error of the mean as an estimate of its
// expectation.
struct ClampLedger {
  OmissionLedger pixels;            // removed radiance of all pixels and channels
  std::array<Sum, 3> sum, squares;  // by channel: total of the tile sums, and total of their squares
  double tiles = 0;

  double mean(std::size_t channel) const {
    return pixels.values > 0 ? sum[channel] * 3 / pixels.values / pixels.samples : 0;
  }
  double standard_error(std::size_t channel) const {
    if (tiles < 2) return std::numeric_limits<double>::infinity();
    const double of_tile = sum[channel] / tiles;
    const double variance =
        std::max(0.0, squares[channel] / tiles - of_tile * of_tile) * tiles * tiles / (tiles - 1);
    return std::sqrt(variance) * 3 / pixels.values / pixels.samples;
  }

  void add_tile(const std::array<double, 3>& of_channels) {
    for (std::size_t c = 0; c < 3; ++c) {
      sum[c] += of_channels[c];
      squares[c] += of_channels[c] * of_channels[c];
    }
    ++tiles;
  }
  // Adds the ledger of other pixels with the same number of samples.
  void add(const ClampLedger& other) {
    pixels.add(other.pixels);
    add_sums(other);
  }
  // Adds the ledger of other samples of the same pixels. Its tiles count as additional tiles, so the standard
  // error tends to be overestimated.
  void join(const ClampLedger& other) {
    pixels.join(other.pixels);
    add_sums(other);
  }

 private:
  void add_sums(const ClampLedger& other) {
    for (std::size_t c = 0; c < 3; ++c) {
      sum[c] += other.sum[c];
      squares[c] += other.squares[c];
    }
    tiles += other.tiles;
  }
};

}  // namespace orrery
