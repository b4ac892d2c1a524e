#pragma once

#include "core/budget/renderer.h"
#include "core/plan/plan.h"

namespace orrery {

// Plans, settles and renders one image. Throws InputError if the options do not fit the scene, and Cancelled
// after a stop request.
inline RenderResult render_picture(const PreparedScene& scene, const RenderRequest& request,
                                   FilmStorage storage, Executor& executor, const std::stop_token& stop) {
  const SettledPlan plan = settle(scene, make_plan(scene.scene(), request), stop);
  return render_frame(scene, plan, storage, executor, {.stop = stop});
}

}  // namespace orrery
