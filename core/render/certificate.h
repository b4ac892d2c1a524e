#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/model/plan.h"
#include "core/render/backend.h"

namespace orrery {

// How far a picture may be from the reference: the picture that its technique makes without cuts, of
// endlessly many samples over each pixel, by exact arithmetic. (Light that the technique does not follow at
// all is no part of it.) In the plan's space.
struct Certificate {
  static constexpr double kConfidence = 0.95, kDoubt = 1 - kConfidence;  // of what is estimated, over seeds

  static constexpr const char* kSamples = "samples";  // the subject of what they leave

  struct Term {
    std::string subject;
    Bound bound;
    std::string reason = {};  // why it is unknown
  };
  std::vector<Term> terms;
  Space space = Space::linear;
  // RMS below which no samples of a picture of that size can prove their error; none if no size can.
  std::optional<double> least_provable = {};
  // RMSE that the halves of the samples tell: of noise, so it is no part of a sum.
  std::optional<double> estimate = {};

  // What an option takes away on purpose: the mean over the picture by which this run differs from the one
  // without it, per channel, exactly; and the standard error of that as a bias, infinite where one tile
  // tells.
  struct Bias {
    std::string option;
    double value;
    std::array<double, 3> mean, standard_error;
  };
  std::vector<Bias> biases = {};
  // Plan::not_followed: beside these, the reference is all light there is.
  std::vector<const char*> not_followed = {};

  Bound total() const;  // as weak as the weakest term
  Bound known() const;  // of the terms that are not unknown
  // Of the terms that keep(term) says.
  template <class Keep>
  Bound total_of(const Keep& keep) const {
    Bound sum;
    for (const Term& term : terms)
      if (keep(term)) sum = sum + term.bound;
    if (space == Space::display)  // no two values differ by more than 1
      for (std::optional<double>* most : {&sum.max, &sum.rms})
        if (*most) *most = std::min(1.0, **most);
    return sum;
  }
};

// RMS that halves of a picture of that size would prove if they agreed everywhere: the least that samples can
// prove, of the plan's technique alone. None where nothing limits a sample.
std::optional<double> least_provable(const Plan& plan, double doubt = Certificate::kDoubt);

// `doubt` is the probability with which what is estimated may be wrong: less than kDoubt if others
// are looked at, too.
Certificate certify(const Plan& plan, const RenderStats& stats, double doubt = Certificate::kDoubt);

}  // namespace orrery
