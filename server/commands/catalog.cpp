#include "server/api/catalog.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "server/commands/commands.h"

namespace orrery {

Command add_catalog(CLI::App& root) {
  CLI::App* app =
      root.add_subcommand("catalog", "Print all shapes, materials, lights and other types as JSON");
  return {app, [] {
            std::cout << catalog_json().dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
            return kDone;
          }};
}

}  // namespace orrery
