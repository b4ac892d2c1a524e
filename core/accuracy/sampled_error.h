#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/sum.h"

namespace orrery {

// Error estimate of an image from the difference between two halves of its samples. Each half is a
// low-discrepancy net. For means a and b of the halves, the expectation of (a - b)^2 / 4 is the mean square
// error of their mean if the halves are independent. Otherwise the expectation is larger: at edges, the
// estimated RMSE is 1.6 times too large for 2 samples and 1.2 times for 16. Sums run over values, three per
// pixel. For blocks of 4 x 4 and 32 x 32 pixels, the differences of a block are averaged before they are
// squared.
struct SampledError {
  struct MeanSquare {
    Sum squares = 0;    // sum of ((a - b) / 2)^2
    double values = 0;  // number of terms in `squares`

    double rmse() const { return values > 0 ? std::sqrt(squares / values) : 0; }
  };
  int samples = 0;                    // per pixel
  MeanSquare pixel, block4, block32;  // block4, block32: only blocks entirely inside the image
  // Moments of the tiles' mean squares. Tiles are independent, while pixels within a tile may not be.
  double tiles = 0;
  Sum tile_sum = 0, tile_squares = 0;
  // Moments of the sums of ((a - b) / 2)^2 over blocks of 4 x 4 pixels, also of blocks at the image border.
  double blocks = 0;
  Sum block_sum = 0, block_squares = 0;

  bool known() const { return pixel.values > 0; }

  void add(const SampledError& other) {
    const auto add_sum = [](MeanSquare& to, const MeanSquare& from) {
      to.squares += from.squares;
      to.values += from.values;
    };
    samples = std::max(samples, other.samples);
    add_sum(pixel, other.pixel);
    add_sum(block4, other.block4);
    add_sum(block32, other.block32);
    tiles += other.tiles;
    tile_sum += other.tile_sum;
    tile_squares += other.tile_squares;
    blocks += other.blocks;
    block_sum += other.block_sum;
    block_squares += other.block_squares;
  }

  // Returns the estimate for `other_samples` samples per pixel, with mean squares `times` times as large, and
  // for `more` times as many blocks.
  SampledError scaled(int other_samples, double times, double more = 1) const {
    SampledError all = *this;
    all.samples = other_samples;
    for (MeanSquare* sum : {&all.pixel, &all.block4, &all.block32}) sum->squares *= times;
    all.tile_sum *= times;
    all.tile_squares *= times * times;
    all.blocks *= more;
    all.block_sum *= more * times;
    all.block_squares *= more * times * times;
    return all;
  }

  // Returns the effective number of tiles, (sum m)^2 / sum m^2 for the tiles' mean squares m. It equals the
  // number of tiles if all m are equal.
  double tiles_that_err() const { return tile_squares > 0 ? tile_sum * tile_sum / tile_squares : tiles; }

  // 95 % confidence interval of the RMSE over pixels, for normally distributed means over tiles. The upper
  // end is infinite for fewer than two tiles.
  struct Interval {
    double low, high;
  };
  Interval interval() const {
    const double square = pixel.values > 0 ? pixel.squares / pixel.values : 0;
    if (tiles < 2) return {0, std::numeric_limits<double>::infinity()};
    const double off = 1.96 * standard_error(tiles, tile_sum, tile_squares);
    return {std::sqrt(std::max(0.0, square - off)), std::sqrt(square + off)};
  }

  // Returns an estimated upper bound of the expected RMSE over pixels, valid with probability 1 - doubt if
  // the mean over blocks of 4 x 4 pixels is normally distributed. The bound is the upper end of a Student's t
  // interval over blocks, or over tiles if only tiles are independent. The spread between blocks includes
  // differences of the image content, so the interval tends to be too wide. Light that no sample found is not
  // included. Returns infinity for fewer than 4 independent units, and 0 if all halves are equal.
  double upper_rmse(double doubt, bool tiles_alone_are_independent) const;

 private:
  // Returns the standard error of the mean of `count` independent values with these moments. REQUIRES: count
  // is at least 2.
  static double standard_error(double count, double sum, double squares) {
    const double mean = sum / count;
    return std::sqrt(std::max(0.0, squares / count - mean * mean) / (count - 1));
  }
};

}  // namespace orrery
