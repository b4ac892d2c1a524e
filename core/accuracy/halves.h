#pragma once

#include <cmath>

#include "core/accuracy/unit_histogram.h"
#include "core/math/sum.h"

namespace orrery {

// Statistics of the differences between the two halves of the samples. The value of a pixel is the squared
// difference divided by the squared Plan::halves_range(), averaged over the channels, in [0, 1]. In display
// space, also records the rounding errors of 8-bit codes, and the excess of a pixel: its radiance above
// display white in one half, if the other half is below white.
class Halves {
 public:
  void add(double value) { pixels_.add(value); }  // value of a pixel
  // Adds the sum of the pixel values of a tile.
  void add_tile(double sum) {
    sum_ += sum;
    squares_ += sum * sum;
    ++tiles_;
  }
  // Adds the excess of a pixel, in [0, most]. `most` is Plan::beyond_range() and may be infinite.
  void add_beyond(double value, double most) {
    beyond_.add(value / most);
    if (value > 0) beyond_sum_ += value;
  }
  // Adds the rounding errors of `codes` 8-bit codes. `squares` is the sum of their squares, in display values
  // (0 to 1).
  void add_rounding(double squares, double codes) {
    rounding_squares_ += squares;
    codes_ += codes;
  }
  void add(const Halves& other);  // adds the statistics of other tiles
  // Returns the statistics scaled to `more_pixels` times as many pixels and tiles, and to squared differences
  // `squares` times as large.
  Halves scaled(double more_pixels, double squares) const;

  bool known() const { return pixels_.count() > 0; }
  double mean() const { return pixels_.mean(); }
  double rounding() const { return codes_ > 0 ? std::sqrt(rounding_squares_ / codes_) : 0; }  // RMS
  // Returns an upper bound of the expected value of a pixel, valid with probability 1 - doubt. The bound is
  // that of UnitHistogram::upper_mean(), for independent pixels of any distribution. If only tiles are
  // independent, the bound is at least the upper end of a Student's t interval over tiles, or 1 for fewer
  // than two tiles.
  double upper_mean(double doubt, bool tiles_alone_are_independent) const;
  // Returns an upper bound of the expected excess for independent pixels, valid with probability 1 - doubt.
  // If `most` is infinite, returns the mean excess.
  double upper_beyond(double doubt, double most) const;

 private:
  double upper_mean_of_tiles(double doubt) const;

  UnitHistogram pixels_, beyond_;
  Sum beyond_sum_, rounding_squares_;
  double codes_ = 0, tiles_ = 0;
  Sum sum_, squares_;  // moments of the tile sums
};

// Returns the t that a variable of Student's distribution with `degrees` degrees of freedom exceeds with
// probability `tail` (Abramowitz and Stegun, "Handbook of mathematical functions", 26.7.3 and 26.7.4). Above
// 200 degrees, returns the value for 200, which is about 1 % too large. REQUIRES: degrees >= 1; tail in (0,
// 0.5).
double student_quantile(double tail, int degrees);

}  // namespace orrery
