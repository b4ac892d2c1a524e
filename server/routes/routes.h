#pragma once

#include "server/app/app.h"
#include "server/routes/router.h"

namespace orrery {

// Adds all endpoints of registry.cpp. The app must outlive the router.
void add_routes(Router& router, App& app);

// Adds the health endpoints only, for the health port.
void add_health_routes(Router& router, App& app);

}  // namespace orrery
