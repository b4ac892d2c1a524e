#pragma once

#include <prometheus/metric_family.h>

#include <vector>

#include "server/app/app.h"
#include "server/http/server.h"
#include "server/telemetry/log.h"

namespace orrery {

// Returns the current metrics of the service and its process.
std::vector<prometheus::MetricFamily> collect_metrics(App& app, const HttpServer& server, const Log& log);

}  // namespace orrery
