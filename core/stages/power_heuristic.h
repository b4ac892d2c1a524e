#pragma once

namespace orrery {

// Returns the MIS weight of a sample with density `own` if another strategy has density `other` for it. This
// is the power heuristic with exponent 2 (Veach and Guibas, "Optimally Combining Sampling Techniques for
// Monte Carlo Rendering", SIGGRAPH 1995). It is computed from the ratio, since squared densities may overflow
// or underflow.
template <class N>
N power_heuristic(const N& own, const N& other) {
  const N one(1), ratio = other / own;
  return one / (one + ratio * ratio);
}

}  // namespace orrery
