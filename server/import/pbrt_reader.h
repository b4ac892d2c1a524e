#pragma once

#include <string>

#include "server/import/import.h"

namespace orrery {

// Converts a scene of pbrt-v4: see import_scene().
ImportedScene import_pbrt(const std::string& text, const std::string& name, const ReadNearby& nearby,
                          const ImportOptions& options);

}  // namespace orrery
