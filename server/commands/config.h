#pragma once

#include <string>
#include <vector>

#include "core/base/error.h"
#include "server/config/settings.h"

namespace CLI {
class App;
}

namespace orrery {

// Configuration of the service. Each setting has one name. Its value comes from a flag
// (--max-request-body-bytes), else from the environment (ORRERY_MAX_REQUEST_BODY_BYTES), else from a JSON
// file ("max_request_body_bytes"), else from its default.

// Adds a flag for each setting. Unknown flags are accepted here and reported by read_settings().
void add_setting_flags(CLI::App& app);

// Returns the settings from all sources after parsing; `config_file` may be empty. Appends all errors,
// including unknown names, to `problems` with their place: "--port", "ORRERY_PORT" or the file.
Settings read_settings(const CLI::App& app, const std::string& config_file, std::vector<Problem>& problems);

// Returns all settings as a JSON file for --config.
std::string config_text(const Settings& settings);

}  // namespace orrery
