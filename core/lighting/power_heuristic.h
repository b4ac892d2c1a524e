#pragma once

namespace orrery {

// Returns the MIS weight of a sample with density `own` that another strategy samples with density `other`.
// This is the power heuristic with exponent 2 (Veach and Guibas, "Optimally Combining Sampling Techniques for
// Monte Carlo Rendering", SIGGRAPH 1995). The weight is computed from the ratio of the densities, because
// squared densities may overflow or underflow.
template <class N>
N power_heuristic(const N& own, const N& other) {
  const N one(1), ratio = other / own;
  return one / (one + ratio * ratio);
}

}  // namespace orrery
