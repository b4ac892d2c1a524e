#pragma once

#include <nlohmann/json_fwd.hpp>

namespace orrery {

// Returns the types that scenes and requests can name, the sample scenes and the defaults, for menus.
nlohmann::ordered_json catalog_json();

}  // namespace orrery
