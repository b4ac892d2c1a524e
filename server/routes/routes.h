#pragma once

#include "server/app/app.h"
#include "server/routes/router.h"

namespace orrery {

// Every endpoint, one line each in registry.cpp. The app outlives the router.
void add_routes(Router& router, App& app);

// Those alone that supervisors ask, beside /metrics.
void add_health_routes(Router& router, App& app);

}  // namespace orrery
