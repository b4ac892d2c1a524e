#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/budget/renderer.h"

// Error reports of an image, as JSON and as values of response headers.
namespace orrery {

// Returns {"rmse", "rmse_low", "rmse_high", "rmse_4", "rmse_32", "samples", "rays"}. "rmse" is the RMSE of a
// pixel in linear radiance. "rmse_low" and "rmse_high" are the ends of its 95 % confidence interval.
// "rmse_high" is null for fewer than two tiles. "rmse_4" and "rmse_32" are the RMSEs of means of 4 x 4 and 32
// x 32 pixels. "samples" is the number per pixel, "rays" the total. REQUIRES: stats.error.known().
nlohmann::ordered_json error_json(const RenderStats& stats);

// Returns error_json() as a header value: "0.0049; low=0.0046; high=0.0053; of-4=0.0014; of-32=0.0004;
// samples=16; rays=9000". REQUIRES: stats.error.known().
std::string error_text(const RenderStats& stats);

// Returns {"kind", "rms", "max"}. Unknown values are null.
nlohmann::ordered_json bound_json(const Bound& bound);

// Returns {"reference", "space", "confidence", "terms": [{"subject", "bound", "reason"}], "total", "known",
// "light", "estimate", "least_provable", "biases": [{"option", "value", "mean", "standard_error"}]}. "reason"
// explains an unknown bound, or names the assumption of an estimated bound. "estimate", "least_provable" and
// "biases" are present if known. "light" is the total bound, or an unknown bound with "because" if the
// technique ignores some kinds of light.
nlohmann::ordered_json certificate_json(const Certificate& certificate);

// Returns the total bound as a header value:
// "rms=0.0044;kind=estimated;max=unknown;confidence=0.95;estimate=0.0031;reference=technique;space=linear".
// If the kind is unknown, adds because="precision, samples" with the unknown terms. known, known-kind and
// known-max are then the bound of the known terms.
std::string bound_text(const Certificate& certificate);

// Returns {"met", "error", "error_met", "kind", "seconds", "seconds_met", "used_s", "reachable_error",
// "least_seconds", "reason"}. The members for "error" and "seconds" are present if that limit was requested.
// "kind" is the kind of the bound that was compared with the error limit.
// "reachable_error" is the smallest provable error, or null if no error is provable. "least_seconds" is the
// predicted time of the first pass, if it was cancelled as too slow. "reason" explains a miss.
nlohmann::ordered_json budget_json(const BudgetOutcome& outcome);

// Returns the outcome as a header value:
// "met=?0;error=0.001;error-met=?0;kind=estimated;reason=\"...\"" or "met=?1;seconds=2;used=1.83".
std::string budget_text(const BudgetOutcome& outcome);

// Returns the mean and standard error of each bias, for R, G and B, as a header value:
// "clamp_indirect=10;mean=-0.0012 -0.001 -0.0008;error=0.0001 0.0001 0.0001". Returns "" without biases.
std::string bias_text(const Certificate& certificate);

}  // namespace orrery
