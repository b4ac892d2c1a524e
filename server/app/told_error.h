#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/render/renderer.h"

// What a picture tells of its own error: RMSE of linear radiance, with what it took.
namespace orrery {

// {"rmse", "rmse_low", "rmse_high"} of a pixel and the ends of its interval of 95 %, of which the upper one
// is null where one tile alone tells it; "rmse_4" and "rmse_32" of means of 4 x 4 and 32 x 32 pixels;
// "samples" a pixel; "rays" traced. REQUIRES: stats.error.known().
nlohmann::ordered_json error_json(const RenderStats& stats);

// The same for a header: "0.0049; low=0.0046; high=0.0053; of-4=0.0014; of-32=0.0004; samples=16; rays=9000".
// REQUIRES: stats.error.known().
std::string error_text(const RenderStats& stats);

// {"kind", "rms", "max"}, where null is what is not known.
nlohmann::ordered_json bound_json(const Bound& bound);

// {"reference", "space", "confidence", "terms": [{"subject", "bound", "reason"}], "total", "known", "light",
// "estimate", "biases": [{"option", "value", "mean", "standard_error"}]}: a reason where the bound is
// unknown, an estimate where samples tell one, biases where there are some. Against all light that there is,
// `light` is the total, or unknown because of kinds of light that the technique does not follow.
nlohmann::ordered_json certificate_json(const Certificate& certificate);

// The same for a header: "rms=0.0044;kind=estimated;max=unknown;confidence=0.95;estimate=0.0031;
// reference=technique;space=linear"; where the kind is unknown, with because="precision, samples", and with
// known, known-kind and known-max of what is known.
std::string bound_text(const Certificate& certificate);

// {"met", "error", "error_met", "seconds", "seconds_met", "used_s", "reachable_error", "least_seconds",
// "reason"}: what was asked, the least error that can be proved, null if none can, the time that the least
// picture would take where it was given up for that, and a reason where it was missed.
nlohmann::ordered_json budget_json(const BudgetOutcome& outcome);

// The same for a header: "met=?0;error=0.001;reason=\"...\"" or "met=?1;seconds=2;used=1.83".
std::string budget_text(const BudgetOutcome& outcome);

// Of each bias for a header: "clamp_indirect=10;mean=-0.0012 -0.001 -0.0008;error=0.0001 0.0001 0.0001", by
// channel; empty if there is none.
std::string bias_text(const Certificate& certificate);

}  // namespace orrery
