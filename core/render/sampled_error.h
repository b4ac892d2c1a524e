#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/sum.h"

namespace orrery {

// What a picture tells of its own error: half of its samples against the other half, as each half is a net of
// its own. For means a and b of the halves, (a - b)^2 / 4 has the mean square error of their mean as its
// expectation, where the halves are independent, and overestimates it where they are not: of edges, RMSE
// 1.6 times at 2 samples and 1.2 times at 16. Sums over values, three a pixel, by the side of the blocks that
// are averaged first.
struct SampledError {
  struct MeanSquare {
    Sum squares = 0;
    double values = 0;

    double rmse() const { return values > 0 ? std::sqrt(squares / values) : 0; }
  };
  int samples = 0;                    // of a pixel, which it is the error of
  MeanSquare pixel, block4, block32;  // blocks lie wholly in the picture
  // Of the tiles' mean squares: tiles are independent of each other, pixels of one may not be.
  double tiles = 0;
  Sum tile_sum = 0, tile_squares = 0;

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
  }

  // Of other samples of the pixels, with mean squares that are so many times as large.
  SampledError scaled(int other_samples, double times) const {
    SampledError all = *this;
    all.samples = other_samples;
    for (MeanSquare* sum : {&all.pixel, &all.block4, &all.block32}) sum->squares *= times;
    all.tile_sum *= times;
    all.tile_squares *= times * times;
    return all;
  }

  // How many tiles that err alike would have mean squares that spread as much.
  double tiles_that_err() const { return tile_squares > 0 ? tile_sum * tile_sum / tile_squares : tiles; }

  // Of the RMSE of a pixel: 95 % of normal errors lie within.
  struct Interval {
    double low, high;
  };
  Interval interval() const {
    const double square = pixel.values > 0 ? pixel.squares / pixel.values : 0;
    if (tiles < 2) return {0, std::numeric_limits<double>::infinity()};
    const double mean = tile_sum / tiles;
    const double spread = std::max(0.0, tile_squares / tiles - mean * mean) * tiles / (tiles - 1);
    const double off = 1.96 * std::sqrt(spread / tiles);
    return {std::sqrt(std::max(0.0, square - off)), std::sqrt(square + off)};
  }
};

}  // namespace orrery
