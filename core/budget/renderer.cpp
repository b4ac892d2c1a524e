#include "core/budget/renderer.h"

#include "core/budget/budget.h"
#include "core/plan/options.h"
#include "core/render/progressive.h"

namespace orrery {

RenderResult render_frame(const PreparedScene& scene, const SettledPlan& plan, FilmStorage storage,
                          Executor& executor, const RenderControl& control) {
  if (has_budget(plan->asked)) return render_within_budget(scene, plan, executor, control);
  RenderStats stats;
  Film film = render_film(scene, plan, storage, executor, stats, control);
  return {std::move(film), stats, certify(*plan, stats)};
}

}  // namespace orrery
