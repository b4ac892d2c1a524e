#pragma once

#include <cmath>

namespace orrery {

// Compensated sum, independent of the order of its terms. Rounding errors are summed separately (Knuth, "The
// Art of Computer Programming", volume 2, 4.2.2, theorem B). Only a last bit within 1e-16 of a tie may
// differ.
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
