#pragma once

namespace orrery {

// The share of what one strategy found that counts, where another would have found it with density `other`
// (Veach and Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering", SIGGRAPH 1995: the
// power heuristic with exponent 2), as a ratio: squares of densities may be out of range.
template <class N>
N power_heuristic(const N& own, const N& other) {
  const N one(1), ratio = other / own;
  return one / (one + ratio * ratio);
}

}  // namespace orrery
