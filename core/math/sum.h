#pragma once

#include <cmath>

namespace orrery {

// A sum of numbers that comes in any order to the same: what rounding takes from it is summed besides (Knuth,
// "The Art of Computer Programming", volume 2, 4.2.2, theorem B). Only a last bit that lies within 1e-16 of a
// tie might tell orders apart.
class Sum {
 public:
  Sum(double first = 0) : sum_(first) {}
  operator double() const { return sum_ + rest_; }

  Sum& operator+=(double x) {
    const double sum = sum_ + x, added = sum - sum_;
    if (std::isfinite(sum)) rest_ += (sum_ - (sum - added)) + (x - added);
    sum_ = sum;
    return *this;
  }
  Sum& operator+=(const Sum& other) {
    *this += other.sum_;
    rest_ += other.rest_;
    return *this;
  }
  Sum& operator*=(double factor) { return *this = double{*this} * factor; }

 private:
  double sum_, rest_ = 0;
};

}  // namespace orrery
