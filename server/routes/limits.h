#pragma once

#include <nlohmann/json_fwd.hpp>

namespace orrery {

// Adds all limits to `schema`, the JSON Schema of GET /v1/limits.
void add_limit_schemas(nlohmann::ordered_json& schema);

}  // namespace orrery
