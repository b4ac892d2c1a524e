#pragma once

#include "server/app/app.h"
#include "server/routes/router.h"

namespace orrery {

// Adds the endpoints of all files in registry.cpp. The app must outlive the router.
void add_routes(Router& router, App& app);

// Adds only the health endpoints, for the health port.
void add_health_routes(Router& router, App& app);

}  // namespace orrery
