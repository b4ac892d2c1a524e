#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/task_scope.h"
#include "core/materials/facet_albedo.h"
#include "core/model/record.h"

namespace orrery {

// Smallest textured roughness: its alpha is just above kMinAlpha, so a textured surface is never smooth.
inline constexpr double kMinTexturedRoughness = 0.03163;

// Inputs with a member `roughness` whose square is the alpha of the GGX distribution, and a function
// tabulate(roughness) that computes all members after `roughness`, by quadrature.
template <class Inputs>
concept Tabulated = requires(Inputs& inputs) {
  inputs.tabulate(inputs.roughness);
};

// Tabulated inputs whose members after `roughness` depend on no other member.
template <class Inputs>
concept TabulatesRoughnessOnly = Tabulated<Inputs> && requires {
  requires Inputs::kTabulatesRoughnessOnly;
};

// Members of tabulated inputs after `roughness`, the first of which is alpha, for values of roughness at
// equal distances. Albedos are smooth functions of alpha at fixed nodes of their series, so that the
// coefficients are interpolated linearly in alpha, as ggx_albedo() does.
template <class T>
class RoughnessTable {
 public:
  RoughnessTable() = default;
  // Tabulates the range of roughness from `least` to `most`. Throws Cancelled.
  template <class Inputs>
  RoughnessTable(Inputs inputs, double least, double most) {
    constexpr double kRowsPerUnit = 47;
    const int rows = 2 + static_cast<int>((most - least) * kRowsPerUnit);
    from_ = static_cast<T>(least);
    per_roughness_ = most > least ? static_cast<T>((rows - 1) / (most - least)) : T(0);
    const double* const end = reinterpret_cast<const double*>(&inputs + 1);
    count_ = static_cast<std::size_t>(end - &inputs.roughness) - 1;
    for (int row = 0; row < rows; ++row) {
      checkpoint();
      inputs.tabulate(least + (most - least) * row / (rows - 1));
      for (const double* number = &inputs.roughness + 1; number != end; ++number)
        numbers_.push_back(static_cast<T>(*number));
    }
  }

  template <class U>
  requires(!std::is_same_v<U, T>) explicit RoughnessTable(const RoughnessTable<U>& other)
      : numbers_(other.numbers_.begin(), other.numbers_.end()),
        count_(other.count_),
        from_(static_cast<T>(other.from_)),
        per_roughness_(static_cast<T>(other.per_roughness_)) {}

  bool empty() const { return numbers_.empty(); }
  // Calls set(k, value) for the k-th member after `roughness`.
  template <class Set>
  void interpolate(T roughness, const Set& set) const {
    const T last = static_cast<T>(numbers_.size() / count_ - 1);
    const T place = std::min(last - 1, std::max(T(0), (roughness - from_) * per_roughness_));
    const T* const numbers = &numbers_[static_cast<std::size_t>(place) * count_];
    const T below = numbers[0], above = numbers[count_];
    const T share =
        above > below ? std::clamp((roughness * roughness - below) / (above - below), T(0), T(1)) : T(0);
    for (std::size_t k = 0; k < count_; ++k) set(k, numbers[k] + (numbers[count_ + k] - numbers[k]) * share);
  }

 private:
  template <class U>
  friend class RoughnessTable;
  std::vector<T> numbers_;  // by row
  std::size_t count_ = 1;   // per row
  T from_{}, per_roughness_{};
};

}  // namespace orrery
