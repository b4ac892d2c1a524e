#pragma once

#include <cmath>

#include "core/math/sum.h"
#include "core/render/unit_histogram.h"

namespace orrery {

// How the two halves of the samples differ: of each pixel the mean over channels of the squared difference,
// over that of what samples may differ by, so in [0, 1]. On a display, also how much brighter one half is
// than any that is shown, in radiance, where the other one is not, and how far codes of 8 bits lie beside
// what all samples show.
class Halves {
 public:
  void add(double value) { pixels_.add(value); }
  // The sum over a tile of what was added.
  void add_tile(double sum) {
    sum_ += sum;
    squares_ += sum * sum;
    ++tiles_;
  }
  // `most` that it may be, perhaps infinite.
  void add_beyond(double value, double most) {
    beyond_.add(value / most);
    if (value > 0) beyond_sum_ += value;
  }
  // Squares of how far so many codes are off, over the range of codes.
  void add_rounding(double squares, double codes) {
    rounding_squares_ += squares;
    codes_ += codes;
  }
  void add(const Halves& other);  // of other tiles
  // Of a picture with so many times the pixels and tiles, of which `squares` times as much is told.
  Halves scaled(double more_pixels, double squares) const;

  bool known() const { return pixels_.count() > 0; }
  double mean() const { return pixels_.mean(); }
  double rounding() const { return codes_ > 0 ? std::sqrt(rounding_squares_ / codes_) : 0; }  // RMS
  // At least the mean of what they were drawn from, with probability 1 - doubt: of pixels that are
  // independent whatever they are drawn from, see UnitHistogram. Where those of a tile depend on each other,
  // at least what tiles tell by Student's t as well, of which there must be two, else 1.
  double upper_mean(double doubt, bool tiles_alone_are_independent) const;
  // Likewise of what is beyond, of independent pixels; where it may be infinitely much, what was met.
  double upper_beyond(double doubt, double most) const;

 private:
  double upper_mean_of_tiles(double doubt) const;

  UnitHistogram pixels_, beyond_;
  Sum beyond_sum_, rounding_squares_;
  double codes_ = 0, tiles_ = 0;
  Sum sum_, squares_;  // of sums over a tile
};

// t for which a variable of Student's distribution with so many degrees of freedom is larger with probability
// `tail` (Abramowitz and Stegun, "Handbook of mathematical functions", 26.7.3 and 26.7.4). Of more than 200
// degrees that of 200, which is 1 % more than at the limit. REQUIRES: degrees >= 1; tail in (0, 0.5).
double student_quantile(double tail, int degrees);

}  // namespace orrery
