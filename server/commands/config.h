#pragma once

#include <string>

#include "server/app/settings.h"

namespace CLI {
class App;
}

namespace orrery {

// How the service is configured: every setting has one name, and comes from a flag (--body-bytes), or else
// the environment (ORRERY_BODY_BYTES), or else a JSON file ("body_bytes"), or else its default.

// Adds an option for each setting. `settings` outlives the parsing.
void add_settings(CLI::App& app, Settings& settings);

// After parsing: takes from the file what neither flag nor environment has set. Throws InputError with the
// places "FILE: /name".
void read_config_file(CLI::App& app, const std::string& path);

// All settings as such a file.
std::string config_text(const CLI::App& app);

}  // namespace orrery
