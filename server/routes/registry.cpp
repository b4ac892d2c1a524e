#include "server/routes/routes.h"

namespace orrery {

// One line for each file of routes. The paths are in these files.
// clang-format off
#define ORRERY_ROUTES(add) \
  add(render)              \
  add(view)                \
  add(scenes)              \
  add(assets)              \
  add(frame)               \
  add(orbit)               \
  add(refinement)          \
  add(jobs)                \
  add(frame_jobs)          \
  add(charts)              \
  add(shares)              \
  add(explain)             \
  add(catalog)             \
  add(limits)              \
  add(stability)           \
  add(health)              \
  add(schema)              \
  add(openapi)             \
  add(files)
// clang-format on

#define ORRERY_DECLARE(name) void add_##name##_routes(Router& router, App& app);
#define ORRERY_CALL(name) add_##name##_routes(router, app);

ORRERY_ROUTES(ORRERY_DECLARE)

void add_routes(Router& router, App& app) { ORRERY_ROUTES(ORRERY_CALL) }

}  // namespace orrery
