#include "core/accuracy/sampled_error.h"

#include "core/accuracy/halves.h"

namespace orrery {

double SampledError::upper_rmse(double doubt, bool tiles_alone_are_independent) const {
  constexpr double kMinUnits = 4;
  // Fraction of `doubt` at which t is taken. Squares of errors are skewed, so their sampled spread is too
  // small. With errors in one block of fifty, a t interval over 1,024 blocks covers 90 % instead of 95 %.
  constexpr double kSkewed = 0.25;
  const double units = tiles_alone_are_independent ? tiles : blocks;
  if (pixel.squares == 0) return 0;
  if (units < kMinUnits) return std::numeric_limits<double>::infinity();
  const double mean = (tiles_alone_are_independent ? tile_sum : block_sum) / units;
  const double off = tiles_alone_are_independent ? standard_error(units, tile_sum, tile_squares)
                                                 : standard_error(units, block_sum, block_squares);
  const double t = student_quantile(kSkewed * doubt, static_cast<int>(std::min(units, 1e6)) - 1);
  return pixel.rmse() * std::sqrt(1 + t * off / mean);
}

}  // namespace orrery
