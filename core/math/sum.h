#pragma once

#include <cmath>

namespace orrery {

// Compensated sum. Rounding errors are summed separately (Knuth, "The Art of Computer Programming", volume 2,
// 4.2.2, theorem B). The order of the terms can change only the last bit, and only if the exact sum is almost
// half way between two doubles.
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
