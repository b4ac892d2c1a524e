#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/accuracy/render_stats.h"
#include "core/model/plan.h"

namespace orrery {

// Error of an image relative to its reference, in the plan's error metric. The reference is the image of the
// same technique with all rays, infinitely many samples per pixel and exact arithmetic. Light that the
// technique does not follow is missing from the reference, too.
struct Certificate {
  static constexpr double kConfidence = 0.95,
                          kAlpha = 1 - kConfidence;  // confidence of estimated bounds, over all seeds

  static constexpr const char* kSamples = "samples";  // Term::subject of the sampling error

  struct Term {
    std::string subject;
    Bound bound;
    std::string reason = {};  // why the bound is unknown, or what an estimated bound assumes
  };
  std::vector<Term> terms;
  Space space = Space::linear;
  // Smallest RMS error that samples can prove for an image of this size, or nullopt if they cannot prove one.
  std::optional<double> min_provable = {};
  // RMSE estimated from the two halves of the samples, or nullopt if the halves were not compared. The
  // estimate is noisy and not part of total().
  std::optional<double> estimate = {};

  // Intended bias of an option with value `value`. `mean` is the exact mean difference in radiance, per
  // channel, from the same render without the option. `standard_error` is the standard error of `mean` as an
  // estimate of the bias. It is infinite for a single tile.
  struct Bias {
    std::string option;
    double value;
    std::array<double, 3> mean, standard_error;
  };
  std::vector<Bias> biases = {};
  // Kinds of light that the reference lacks: Plan::not_followed.
  std::vector<const char*> not_followed = {};

  Bound total() const;  // sum of all terms, with the weakest kind of evidence
  Bound known() const;  // sum of the terms with a known bound
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

// Returns the RMS bound of an image of the plan's size if both halves of the samples are equal in every
// pixel. Samples cannot prove a smaller bound. Returns nullopt if the radiance of a sample is unbounded.
// `doubt` has the same meaning as in certify(). Thread-safe.
std::optional<double> min_provable(const Plan& plan, double doubt = Certificate::kAlpha);

// Returns the certificate of an image. `doubt` is the probability that an estimated bound is wrong. It must
// be less than kAlpha if several certificates of one render are examined. Thread-safe; throws only
// std::bad_alloc.
Certificate certify(const Plan& plan, const RenderStats& stats, double doubt = Certificate::kAlpha);

}  // namespace orrery
