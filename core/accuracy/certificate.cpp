#include "core/accuracy/certificate.h"

#include "core/image/srgb.h"
#include "core/model/technique.h"

namespace orrery {
namespace {

// Converts bounds in radiance to display values. The sRGB curve e is concave and 0 at 0, so display values
// differ by at most e of the radiance difference. The mean of e^2 is at most the concave envelope of e^2 at
// the mean. The envelope is a chord from 0 to the point of contact, and e^2 beyond it.
constexpr double kCurveError = 3e-6;
double display_max(double max) { return std::min(1.0, encode_srgb(max) + kCurveError); }
double display_rms(double mean) {
  constexpr double kTouches = 0.0615, kSlope = 1.2304;
  const double encoded = encode_srgb(mean);
  return std::min(1.0, std::sqrt(mean < kTouches ? kSlope * mean : encoded * encoded) + kCurveError);
}

// Returns the bound, in the plan's error metric, on the error from the light in `away`. An estimated bound
// has no maximum.
Bound bound_of(const Plan& plan, const OmissionLedger& away, bool proved) {
  const bool display = plan.space == Space::display;
  const double max = display ? display_max(away.max()) : away.max();
  const double rms = display ? std::min(max, display_rms(away.mean())) : away.rms();
  return proved ? Bound::proved(max, rms) : Bound::estimated(rms);
}

// Bounds the light of untraced rays, from the ledger. Path weights are random, so the bound for paths is an
// estimate.
Certificate::Term omitted_term(const Plan& plan, const RenderStats& stats) {
  const char* const subject = "rays not traced";
  if (stats.counts.cut_rays == 0) return {subject, {}};
  const OmissionLedger& omitted = stats.omitted;
  if (!std::isfinite(omitted.max() + omitted.rms()))
    return {subject, Bound::unknown(), "their radiance is unbounded"};
  return {subject, bound_of(plan, omitted, !plan.technique->draws_light)};
}

// Bounds the light that the clamp removed.
Certificate::Term clamp_term(const Plan& plan, const RenderStats& stats) {
  const char* const subject = "indirect light clamp";
  const OmissionLedger& away = stats.clamped.pixels;
  if (away.sum == 0) return {subject, {}};
  if (!std::isfinite(away.max() + away.rms()))
    return {subject, Bound::unknown(), "the removed light is unbounded"};
  return {subject, bound_of(plan, away, false)};
}

Certificate::Term precision_term(const Plan& plan) {
  if (plan.double_precision) return {"precision", {}};
  return {"precision", Bound::unknown(), "no ray was traced in double precision for comparison"};
}

// Returns whether the errors of a tile's pixels are correlated. For independent errors, the mean square error
// of tile means is 1/1024 of the mean square error of pixels, times chi^2 over its degrees of freedom. There
// is one degree of freedom per tile if all tiles have equal errors. The limit is a quantile of chi^2 (Wilson,
// Hilferty 1931), exceeded with probability 1e-7. Returns false for fewer than 16 whole tiles.
bool pixels_are_alike(const SampledError& error) {
  constexpr double kMinTiles = 16, kZ = 5.2;
  const double pixel = error.pixel.rmse(), tile = error.block32.rmse();
  const double spread = 2 / (9 * error.tiles_that_err()),
               most = std::pow(1 - spread + kZ * std::sqrt(spread), 3);
  return error.block32.values >= 3 * kMinTiles && tile * tile > most * pixel * pixel / kBatch;
}

// Bounds the sampling error if the radiance of a sample is unbounded.
Certificate::Term unlimited_term(const SampledError& error, double doubt, bool reused) {
  const char* const subject = Certificate::kSamples;
  const double upper = error.upper_rmse(doubt, reused);
  if (upper == 0)
    return {subject, Bound::unknown(), "radiance of a sample is unbounded, and all samples of a pixel agree"};
  if (!std::isfinite(upper))
    return {subject, Bound::unknown(),
            "radiance of a sample is unbounded, and the image has fewer than four " +
                std::string(reused ? "tiles" : "blocks of 4x4 pixels")};
  return {subject, Bound::estimated(upper),
          "radiance of a sample is unbounded: the bound assumes that the samples found all bright light"};
}

// Bounds the sampling error. For means a and b of the halves, (a - b)^2 / 4 is on average at least the
// squared error of their mean. No difference exceeds the range of a sample. In display values, bright samples
// that only one half found are clipped. The clipping hides an error of about the radiance above display white
// in that half. (A sample that is too dim to be clipped appears in the difference.) If samples have no range,
// no bound is valid for every distribution of the errors, and the spread of the errors over the image
// replaces the range.
Certificate::Term sampling_term(const Plan& plan, const RenderStats& stats, double doubt) {
  const char* const subject = Certificate::kSamples;
  if (!stats.error.known())
    return {subject, Bound::unknown(), "the error can be estimated only for an even number of samples"};
  const bool reused = plan.reuse > 1;
  if (!reused && pixels_are_alike(stats.error))
    return {subject, Bound::unknown(), "pixel errors within a tile are correlated"};
  if (!stats.halves.known()) return unlimited_term(stats.error, doubt, reused);
  const double beyond = plan.beyond_range(stats.error.samples), part = beyond > 0 ? doubt / 2 : doubt;
  const double seen = plan.halves_range() * std::sqrt(stats.halves.upper_mean(part, reused)) / 2;
  if (beyond == 0) return {subject, Bound::estimated(seen)};
  return {subject, Bound::estimated(seen + display_rms(stats.halves.upper_beyond(part, beyond)))};
}

// Bounds the rounding to 8-bit codes, which is at most half a code. If it was not measured, a uniform
// distribution is assumed.
Certificate::Term encoding_term(const RenderStats& stats) {
  const char* const subject = "8-bit codes";
  constexpr double kHalf = 0.5 / 255;
  if (!stats.halves.known()) return {subject, {Bound::Kind::estimated, kHalf, kHalf / std::sqrt(3.0)}};
  return {subject, Bound::proved(kHalf + kCurveError, stats.halves.rounding() + kCurveError)};
}

}  // namespace

std::optional<double> min_provable(const Plan& plan, double doubt) {
  if (!std::isfinite(plan.halves_range())) return {};
  const double pixels = double(plan.width) * plan.height;
  return plan.halves_range() * std::sqrt(UnitHistogram::min_upper_mean(pixels, doubt)) / 2;
}

Bound Certificate::total() const {
  return total_of([](const Term&) { return true; });
}

Bound Certificate::known() const {
  return total_of([](const Term& term) { return term.bound.kind != Bound::Kind::unknown; });
}

Certificate certify(const Plan& plan, const RenderStats& stats, double doubt) {
  Certificate found{{omitted_term(plan, stats), precision_term(plan), sampling_term(plan, stats, doubt)}};
  found.space = plan.space;
  found.not_followed = plan.not_followed;
  found.min_provable = min_provable(plan, doubt);
  if (plan.technique->rasterizes)
    found.terms.push_back({"triangles", Bound::unknown(), "triangles and interpolation replace surfaces"});
  const bool display = plan.space == Space::display;
  if (display) found.terms.push_back(encoding_term(stats));
  if (stats.error.known())
    found.estimate = display ? std::sqrt(stats.halves.mean()) / 2 : stats.error.pixel.rmse();
  if (plan.clamp_indirect > 0) {
    found.terms.push_back(clamp_term(plan, stats));
    Certificate::Bias& bias = found.biases.emplace_back();
    bias.option = "clamp_indirect";
    bias.value = plan.clamp_indirect;
    for (std::size_t c = 0; c < 3; ++c) {
      bias.mean[c] = 0 - stats.clamped.mean(c);
      bias.standard_error[c] = stats.clamped.standard_error(c);
    }
  }
  if (stats.non_finite_pixels > 0)
    found.terms.push_back({"non-finite values", Bound::unknown(),
                           std::to_string(stats.non_finite_pixels) + " pixels are not finite"});
  return found;
}

}  // namespace orrery
