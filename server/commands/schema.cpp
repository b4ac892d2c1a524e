#include <CLI/CLI.hpp>

#include "core/load/load.h"
#include "server/commands/commands.h"

namespace orrery {

Command add_schema(CLI::App& root) {
  CLI::App* app = root.add_subcommand("schema", "Print the JSON Schema of scenes");
  return {app, [] {
            std::cout << scene_schema();
            return kDone;
          }};
}

}  // namespace orrery
