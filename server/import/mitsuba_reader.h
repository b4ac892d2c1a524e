#pragma once

#include <string>

#include "server/import/import.h"

namespace orrery {

// Converts a scene of Mitsuba 0.6, 2 or 3: see import_scene().
ImportedScene import_mitsuba(const std::string& text, const std::string& name, const ReadNearby& nearby,
                             const ImportOptions& options);

}  // namespace orrery
