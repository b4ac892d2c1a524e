#include "core/render/certificate.h"

#include "core/model/technique.h"

namespace orrery {
namespace {

// Rays that were not traced: what the ledger says. Weights of paths are those that were drawn.
Certificate::Term omitted_term(const Plan& plan, const RenderStats& stats) {
  const char* const subject = "rays not traced";
  if (stats.counts.cut_rays == 0) return {subject, {}};
  const Omitted& omitted = stats.omitted;
  if (!std::isfinite(omitted.max()))
    return {subject, Bound::unknown(), "nothing limits what they would find"};
  if (plan.technique->draws_light) return {subject, Bound::estimated(omitted.rms())};
  return {subject, Bound::proved(omitted.max(), omitted.rms())};
}

Certificate::Term precision_term(const Plan& plan) {
  if (plan.double_precision) return {"precision", {}};
  return {"precision", Bound::unknown(), "no ray was traced in double precision besides"};
}

// With means a and b of the halves, (a - b)^2 / 4 is on average at least the squared error of their mean; and
// no difference is larger than the range.
Certificate::Term sampling_term(const Plan& plan, const RenderStats& stats) {
  const char* const subject = "samples";
  if (!stats.error.known()) return {subject, Bound::unknown(), "only an even number of them tells its error"};
  if (stats.halves.count() == 0) return {subject, Bound::unknown(), "nothing limits what one may bring"};
  const double mean = stats.halves.upper_mean(1 - Certificate::kConfidence);
  return {subject, Bound::estimated(plan.sample_range * std::sqrt(mean) / 2)};
}

}  // namespace

Bound Certificate::total() const {
  Bound sum;
  for (const Term& term : terms) sum = sum + term.bound;
  return sum;
}

Bound Certificate::known() const {
  Bound sum;
  for (const Term& term : terms)
    if (term.bound.kind != Bound::Kind::unknown) sum = sum + term.bound;
  return sum;
}

Certificate certify(const Plan& plan, const RenderStats& stats) {
  Certificate found{{omitted_term(plan, stats), precision_term(plan), sampling_term(plan, stats)}};
  if (stats.error.known()) found.estimate = stats.error.pixel.rmse();
  if (plan.clamp_indirect > 0) {
    found.terms.push_back({"clamp of indirect light", Bound::estimated(stats.clamped.pixels.rms())});
    Certificate::Bias& bias = found.biases.emplace_back();
    bias.option = "clamp_indirect";
    bias.value = plan.clamp_indirect;
    for (std::size_t c = 0; c < 3; ++c) {
      bias.mean[c] = 0 - stats.clamped.mean(c);
      bias.standard_error[c] = stats.clamped.standard_error(c);
    }
  }
  if (stats.non_finite_pixels > 0)
    found.terms.push_back({"values that are not finite", Bound::unknown(),
                           std::to_string(stats.non_finite_pixels) + " pixels have one"});
  return found;
}

}  // namespace orrery
