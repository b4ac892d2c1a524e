#pragma once

#include <string>
#include <vector>

#include "core/model/plan.h"
#include "core/render/backend.h"

namespace orrery {

// How far a picture may be from the reference: the picture that its technique makes without cuts, of
// endlessly many samples over each pixel, by exact arithmetic. (Light that the technique does not follow at
// all is no part of it.) In linear radiance.
struct Certificate {
  static constexpr double kConfidence = 0.95;  // of what is estimated: one-sided

  struct Term {
    std::string subject;
    Bound bound;
    std::string reason = {};  // why it is unknown
  };
  std::vector<Term> terms;
  // RMSE that the halves of the samples tell: of noise, so it is no part of a sum.
  std::optional<double> estimate = {};

  Bound total() const;  // as weak as the weakest term
  Bound known() const;  // of the terms that are not unknown
};

Certificate certify(const Plan& plan, const RenderStats& stats);

}  // namespace orrery
