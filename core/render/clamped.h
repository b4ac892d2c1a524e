#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "core/render/omitted.h"

namespace orrery {

// The ledger of Plan::clamp_indirect: the radiance that it took away, which the same samples without it would
// have. Their mean is known exactly, and by how much that is off its expectation is told by how tiles differ.
struct Clamped {
  Omitted pixels;                   // of all channels
  std::array<Sum, 3> sum, squares;  // by channel, of sums over a tile's pixels and samples
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
  // Other pixels, of the same samples.
  void add(const Clamped& other) {
    pixels.add(other.pixels);
    add_sums(other);
  }
  // Other samples of the same pixels: their tiles count as more tiles, so the error is told rather too large.
  void join(const Clamped& other) {
    pixels.join(other.pixels);
    add_sums(other);
  }

 private:
  void add_sums(const Clamped& other) {
    for (std::size_t c = 0; c < 3; ++c) {
      sum[c] += other.sum[c];
      squares[c] += other.squares[c];
    }
    tiles += other.tiles;
  }
};

}  // namespace orrery
