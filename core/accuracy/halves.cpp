#include "core/accuracy/halves.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace orrery {
namespace {

// Returns the probability that a variable of Student's distribution exceeds t. REQUIRES: t >= 0.
double student_tail(double t, int degrees) {
  const double angle = std::atan(t / std::sqrt(double(degrees)));
  const double sine = std::sin(angle), cosine = std::cos(angle), square = cosine * cosine;
  const bool odd = degrees % 2 == 1;
  double term = odd ? cosine : 1, sum = degrees > 1 ? term : 0;
  for (int k = odd ? 3 : 2; k < degrees - 1; k += 2) {
    term *= square * (k - 1) / k;
    sum += term;
  }
  const double within = odd ? (angle + sine * sum) * 2 / std::numbers::pi : sine * sum;
  return (1 - within) / 2;
}

}  // namespace

double student_quantile(double tail, int degrees) {
  const int capped = std::min(degrees, 200);
  double low = 0, high = 1;
  while (student_tail(high, capped) > tail) high *= 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (student_tail(middle, capped) > tail ? low : high) = middle;
  }
  return high;
}

void Halves::add(const Halves& other) {
  pixels_.add(other.pixels_);
  beyond_.add(other.beyond_);
  beyond_sum_ += other.beyond_sum_;
  rounding_squares_ += other.rounding_squares_;
  codes_ += other.codes_;
  sum_ += other.sum_;
  squares_ += other.squares_;
  tiles_ += other.tiles_;
}

Halves Halves::scaled(double more_pixels, double squares) const {
  Halves all;
  all.pixels_ = pixels_.scaled(more_pixels, squares);
  all.beyond_ = beyond_.scaled(more_pixels, squares);
  all.beyond_sum_ = beyond_sum_ * more_pixels * squares;
  all.rounding_squares_ = rounding_squares_ * more_pixels;
  all.codes_ = codes_ * more_pixels;
  all.tiles_ = tiles_ * more_pixels;
  all.sum_ = sum_ * more_pixels * squares;
  all.squares_ = squares_ * more_pixels * squares * squares;
  return all;
}

double Halves::upper_mean(double doubt, bool tiles_alone_are_independent) const {
  const double of_pixels = pixels_.upper_mean(doubt);
  return tiles_alone_are_independent ? std::max(of_pixels, upper_mean_of_tiles(doubt)) : of_pixels;
}

double Halves::upper_beyond(double doubt, double most) const {
  if (most == 0) return 0;
  return std::isfinite(most) ? most * beyond_.upper_mean(doubt) : beyond_sum_ / beyond_.count();
}

double Halves::upper_mean_of_tiles(double doubt) const {
  if (tiles_ < 2) return 1;
  const double variance = std::max(0.0, squares_ - sum_ * sum_ / tiles_) / (tiles_ - 1);
  const double t = student_quantile(doubt, static_cast<int>(tiles_) - 1);
  return std::min(1.0, (sum_ + t * std::sqrt(tiles_ * variance)) / pixels_.count());
}

}  // namespace orrery
