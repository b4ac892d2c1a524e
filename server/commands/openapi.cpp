#include "server/routes/openapi.h"

#include <CLI/CLI.hpp>

#include "server/base/timer.h"
#include "server/commands/commands.h"
#include "server/routes/routes.h"

namespace orrery {

Command add_openapi(CLI::App& root) {
  CLI::App* app = root.add_subcommand("openapi", "Print the OpenAPI description of the HTTP API");
  return {app, [] {
            SteadyTimer timer;
            App service(Settings(), timer);
            Router router;
            add_routes(router, service);
            std::cout << openapi_text(router);
            return kDone;
          }};
}

}  // namespace orrery
