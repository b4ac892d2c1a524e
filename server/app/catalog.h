#pragma once

#include <nlohmann/json_fwd.hpp>

namespace orrery {

// Everything that can be named in a scene or a request, the sample scenes and the defaults, for menus.
nlohmann::ordered_json catalog_json();

}  // namespace orrery
