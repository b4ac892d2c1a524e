#pragma once

#include <nlohmann/json_fwd.hpp>

namespace orrery {

// Returns the types that scenes and requests can use, the sample scenes and the default options, for menus.
nlohmann::ordered_json catalog_json();

}  // namespace orrery
