#pragma once

#include <prometheus/metric_family.h>

#include <vector>

#include "server/app/app.h"
#include "server/app/log.h"
#include "server/http/server.h"

namespace orrery {

// What is true of the service and its process at this moment, a row a metric.
std::vector<prometheus::MetricFamily> read_metrics(App& app, const HttpServer& server, const Log& log);

}  // namespace orrery
