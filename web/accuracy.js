// Speed and accuracy controls of the page: chart and slider, budgets, and the picture's own error.

import { attach_budgets, budget_of, told_of } from "./budget.js";
import { ChartDialog } from "./chart_dialog.js";
import { Overlay } from "./overlay.js";
import { Tradeoff } from "./tradeoff.js";

const $ = (id) => document.getElementById(id);

// `on` has
//   picture() -> the picture at rest without plan and budget, or null
//   within({seconds, error}) -> the same with a budget
//   seen() -> address of the picture on the stage, or null
//   pause()
//   set({plan, seconds, error}), at most one of them set
// Returns `{show(), rest(), stale(), leave(), mark(state), tell(figures, state)}`.
export function attach_accuracy(on) {
  const overlay = new Overlay($("overlay"));
  const dialog = new ChartDialog($("chart"), $("show-chart"), (index) => tradeoff.choose(index));
  const chips = [...document.querySelectorAll("#budgets button")];
  const parts = {
    budgets: chips.map(budget_of),
    make: $("make-chart"),
    progress: $("chart-progress"),
    part: $("chart-part"),
    stops: $("stops"),
    slider: $("stop"),
    ticks: $("stop-ticks"),
    reference: $("reference"),
    bound: $("bound"),
    use: $("use-plan"),
    line: $("stop-line"),
    note: $("stop-note"),
  };
  const tradeoff = new Tradeoff(parts, overlay, {
    picture: on.picture,
    within: on.within,
    seen: on.seen,
    pause: on.pause,
    use: (plan) => on.set({ plan, seconds: 0, error: 0 }),
    chart: (drawing, points) => dialog.show(drawing, points),
    say: (text) => ($("announcement").textContent = text),
  });
  const mark_budgets = attach_budgets(chips, (budget) => {
    on.set({ plan: "", ...budget });
    // Orbits ignore budgets.
    if (budget.seconds || budget.error) on.pause();
  });
  $("drop-plan").addEventListener("click", () => on.set({ plan: "", seconds: 0, error: 0 }));
  return {
    show: () => tradeoff.show(on.picture()),
    rest: () => tradeoff.rest(),
    stale: () => {
      tradeoff.stale();
      say({ missed: false, text: "" });
    },
    leave: () => tradeoff.leave(),
    mark: (state) => {
      mark_budgets(state);
      $("drop-plan").hidden = !state.plan;
    },
    tell: (figures, state) => say(told_of(figures, state)),
  };
}

function say({ missed, text }) {
  $("told").textContent = $("told").title = text;
  $("told").classList.toggle("missed", missed);
}
