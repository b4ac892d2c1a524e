#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "core/model/plan.h"
#include "core/model/scene.h"
#include "core/render/budget.h"

namespace orrery {

// What a render will model and, choice by choice, why no more. The member "request" is the body of a
// POST /v1/render that gives the same picture, with every option.
// `forecast`: what the picture would take, where that was measured.
nlohmann::ordered_json explain_json(const Scene& scene, const Plan& plan,
                                    const std::optional<Forecast>& forecast = {});
std::string explain_text(const Scene& scene, const Plan& plan, const std::optional<Forecast>& forecast = {});

}  // namespace orrery
