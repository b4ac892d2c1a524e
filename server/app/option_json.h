#pragma once

#include <nlohmann/json_fwd.hpp>

#include "core/plan/options.h"

// Render options as JSON objects for answers.
namespace orrery {

// {key: value} of the options of a section, or of all. REQUIRES: they are given.
nlohmann::ordered_json section_json(const RenderSettings& settings, Section section);
nlohmann::ordered_json options_json(const RenderSettings& settings);

// {key: JSON Schema} of all options as requests have them, from the code that reads them. Each has a
// description, which says the default too where that is the scene's.
nlohmann::ordered_json option_schemas();

}  // namespace orrery
