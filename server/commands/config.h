#pragma once

#include <string>
#include <vector>

#include "core/base/error.h"
#include "server/app/settings.h"

namespace CLI {
class App;
}

namespace orrery {

// How the service is configured: every setting has one name, and comes from a flag (--body-bytes), or else
// the environment (ORRERY_BODY_BYTES), or else a JSON file ("body_bytes"), or else its default.

// Adds a flag for each setting, and lets flags pass that do not exist, for read_settings() to name.
void add_setting_flags(CLI::App& app);

// After parsing: the settings from all sources; config_file may be empty. Whatever is wrong in any of them,
// names that do not exist included, is appended to `problems` with its place: "--port", "ORRERY_PORT" or the
// file.
Settings read_settings(const CLI::App& app, const std::string& config_file, std::vector<Problem>& problems);

// All settings as such a file.
std::string config_text(const Settings& settings);

}  // namespace orrery
