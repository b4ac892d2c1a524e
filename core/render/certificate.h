#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/model/plan.h"
#include "core/render/backend.h"

namespace orrery {

// Error of a picture relative to its reference, in the plan's space. The reference is the picture of the same
// technique without cuts, with infinitely many samples per pixel and exact arithmetic. Light that the
// technique does not follow is missing in the reference, too.
struct Certificate {
  static constexpr double kConfidence = 0.95,
                          kAlpha = 1 - kConfidence;  // confidence of estimates, over seeds

  static constexpr const char* kSamples = "samples";  // subject of the sampling error

  struct Term {
    std::string subject;
    Bound bound;
    std::string reason = {};  // why the bound is unknown
  };
  std::vector<Term> terms;
  Space space = Space::linear;
  // Smallest RMS that the samples of a picture of this size can prove, or nullopt if they can prove none.
  std::optional<double> min_provable = {};
  // RMSE estimated from the halves of the samples. It is noisy and not part of a sum.
  std::optional<double> estimate = {};

  // Intended bias of an option. `mean` is the exact mean difference per channel from the same render without
  // the option. `standard_error` is that of `mean` as an estimate of the bias, and infinite for a single
  // tile.
  struct Bias {
    std::string option;
    double value;
    std::array<double, 3> mean, standard_error;
  };
  std::vector<Bias> biases = {};
  // Light that the reference lacks: Plan::not_followed. The reference has all other light.
  std::vector<const char*> not_followed = {};

  Bound total() const;  // kind of the weakest term
  Bound known() const;  // terms with a known bound only
  // Returns the sum of the terms for which keep(term) is true.
  template <class Keep>
  Bound total_of(const Keep& keep) const {
    Bound sum;
    for (const Term& term : terms)
      if (keep(term)) sum = sum + term.bound;
    if (space == Space::display)  // display values differ by at most 1
      for (std::optional<double>* most : {&sum.max, &sum.rms})
        if (*most) *most = std::min(1.0, **most);
    return sum;
  }
};

// Returns the RMS that the halves of a picture of this size prove if they are equal. This is the smallest
// error that samples can prove for the plan's technique. Returns nullopt if samples have no range.
std::optional<double> min_provable(const Plan& plan, double doubt = Certificate::kAlpha);

// Returns the certificate of a picture. `doubt` is the probability that an estimate is wrong. It must be less
// than kAlpha if several certificates of one render are examined.
Certificate certify(const Plan& plan, const RenderStats& stats, double doubt = Certificate::kAlpha);

}  // namespace orrery
