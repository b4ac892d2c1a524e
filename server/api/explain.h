#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "core/budget/budget.h"
#include "core/model/plan.h"
#include "core/model/scene.h"

namespace orrery {

// Explain what a render will model and what it leaves out, decision by decision. The JSON member "request" is
// the body of a POST /v1/render for the same image, with every option. `forecast`: predicted cost and error,
// if measured.
nlohmann::ordered_json explain_json(const Scene& scene, const Plan& plan,
                                    const std::optional<Forecast>& forecast = {});
std::string explain_text(const Scene& scene, const Plan& plan, const std::optional<Forecast>& forecast = {});

}  // namespace orrery
