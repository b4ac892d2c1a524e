#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/render/renderer.h"

// Reports on the error of an image, as JSON and as values of response headers.
namespace orrery {

// Returns {"rmse", "rmse_low", "rmse_high", "rmse_4", "rmse_32", "samples", "rays"}. "rmse" is the RMSE of a
// pixel in linear radiance, with its 95 % interval. "rmse_4" and "rmse_32" are RMSEs of means of 4 x 4 and 32
// x 32 pixels. "samples" counts per pixel. "rmse_high" is null for fewer than two tiles. REQUIRES:
// stats.error.known().
nlohmann::ordered_json error_json(const RenderStats& stats);

// Returns error_json() for a header: "0.0049; low=0.0046; high=0.0053; of-4=0.0014; of-32=0.0004; samples=16;
// rays=9000". REQUIRES: stats.error.known().
std::string error_text(const RenderStats& stats);

// Returns {"kind", "rms", "max"}. Unknown values are null.
nlohmann::ordered_json bound_json(const Bound& bound);

// Returns {"reference", "space", "confidence", "terms": [{"subject", "bound", "reason"}], "total", "known",
// "light", "estimate", "min_provable", "biases": [{"option", "value", "mean", "standard_error"}]}. "reason"
// explains an unknown bound. "estimate", "min_provable" and "biases" are present if known. "light" is the
// total bound, or unknown if the technique ignores some kinds of light.
nlohmann::ordered_json certificate_json(const Certificate& certificate);

// Returns the total bound for a header:
// "rms=0.0044;kind=estimated;max=unknown;confidence=0.95;estimate=0.0031;reference=technique;space=linear".
// If the kind is unknown, adds because="precision, samples", and known, known-kind and known-max for the
// known terms.
std::string bound_text(const Certificate& certificate);

// Returns {"met", "error", "error_met", "seconds", "seconds_met", "used_s", "reachable_error",
// "min_seconds", "reason"}. "reachable_error" is the least provable error, null if there is none.
// "min_seconds" is the time of the cheapest image, if the render was given up for lack of time. "reason"
// explains a miss.
nlohmann::ordered_json budget_json(const BudgetOutcome& outcome);

// Returns the outcome for a header: "met=?0;error=0.001;reason=\"...\"" or "met=?1;seconds=2;used=1.83".
std::string budget_text(const BudgetOutcome& outcome);

// Returns each bias by channel for a header, or "" if there is none: "clamp_indirect=10;mean=-0.0012 -0.001
// -0.0008;error=0.0001 0.0001 0.0001".
std::string bias_text(const Certificate& certificate);

}  // namespace orrery
