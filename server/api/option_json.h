#pragma once

#include <nlohmann/json_fwd.hpp>

#include "core/plan/options.h"

// Render options as JSON objects for responses.
namespace orrery {

// Return {key: value} for the options of a section, or for all options. REQUIRES: these options are set.
nlohmann::ordered_json section_json(const RenderSettings& settings, Section section);
nlohmann::ordered_json options_json(const RenderSettings& settings);

// Returns {key: JSON Schema} for all options of a request, from the code that reads them. Each description
// names the default if the scene can set the option.
nlohmann::ordered_json option_schemas();

}  // namespace orrery
