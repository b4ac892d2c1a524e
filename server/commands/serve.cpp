#include <CLI/CLI.hpp>
#include "server/commands/commands.h"
namespace orrery {
Command add_serve(CLI::App& root) { return {root.add_subcommand("serve", "later"), [] { return kFailed; }}; }
}
