#include "server/rendering/render_order.h"

#include "core/base/clock.h"
#include "core/plan/plan.h"
#include "core/render/views.h"
#include "server/rendering/picture_key.h"

namespace orrery {

std::string RenderOrder::key() const { return work_key(scene->scene(), request); }

RenderOrder make_order(SceneStore::Prepared scene, RenderRequest request, FileFormat format, Caller caller) {
  const auto start = Clock::now();
  require_layers_kept(request, format);
  choose_space(request, format);
  Plan plan = make_plan(scene->scene(), request);
  return {.scene = std::move(scene),
          .request = std::move(request),
          .format = format,
          .plan = std::move(plan),
          .caller = std::move(caller),
          .plan_ms = milliseconds_since(start)};
}

}  // namespace orrery
