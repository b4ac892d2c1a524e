#include "core/study/interval.h"

#include <cmath>

#include "core/accuracy/halves.h"

namespace orrery {

std::optional<Interval> mean_interval(std::span<const double> values) {
  constexpr double kTail = 0.025;
  if (values.size() < 2) return std::nullopt;
  const auto count = static_cast<double>(values.size());
  double sum = 0, squares = 0;
  for (const double value : values) sum += value;
  const double mean = sum / count;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const double half =
      student_quantile(kTail, static_cast<int>(values.size()) - 1) * std::sqrt(squares / (count - 1) / count);
  return Interval{mean - half, mean + half};
}

}  // namespace orrery
