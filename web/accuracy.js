// Speed and accuracy controls of the page: chart and slider, budgets, and the error of the picture on the
// stage.

import { attachBudgets, budgetOf, budgetStatus } from "./budget.js";
import { ChartDialog } from "./chart-dialog.js";
import { Overlay } from "./overlay.js";
import { Tradeoff } from "./tradeoff.js";

const $ = (id) => document.getElementById(id);

// `on` has
//   picture() -> the picture at rest without plan and budget, or null
//   withBudget({seconds, error}) -> the picture at rest with this budget and no plan
//   shownAddress() -> URL of the picture on the stage, or null
//   pause()
//   set({plan, seconds, error}); at most one is set, the others are "" or 0
//   announce(text), for screen readers
// Returns {hideOverlay()}, to be called when the view moves.
export function attachAccuracy(store, on) {
  const overlay = new Overlay($("overlay"));
  const dialog = new ChartDialog($("chart"), $("show-chart"), (index) => tradeoff.choose(index));
  const chips = [...document.querySelectorAll("#budgets button")];
  const parts = {
    budgets: chips.map(budgetOf),
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
    withBudget: on.withBudget,
    shownAddress: on.shownAddress,
    pause: on.pause,
    use: (plan) => on.set({ plan, seconds: 0, error: 0 }),
    chart: (drawing, points) => dialog.show(drawing, points),
    announce: on.announce,
  });
  attachBudgets(chips, store, (budget) => {
    on.set({ plan: "", ...budget });
    // Pauses, because orbits ignore budgets.
    if (budget.seconds || budget.error) on.pause();
  });
  $("drop-plan").addEventListener("click", () => on.set({ plan: "", seconds: 0, error: 0 }));
  attachStatus(store);

  store.subscribe(["scene", "technique"], () => tradeoff.setPicture(on.picture()));
  store.subscribe(["scene", "technique", "samples", "size", "plan", "seconds", "error"], () => tradeoff.hideOverlay());
  store.subscribe(["playing"], ({ playing }) => playing && tradeoff.hideOverlay());
  store.subscribe(["shows"], ({ shows, playing }) => {
    if (shows === "still" && !playing) tradeoff.predictBudgets();
    else if (shows === "") tradeoff.cancelPrediction();
  });
  return { hideOverlay: () => tradeoff.hideOverlay() };
}

// Shows the error of a picture at rest that was rendered with a plan or a budget.
function attachStatus(store) {
  const status = $("budget-status");
  const show = ({ missed, text }) => {
    status.textContent = status.title = text;
    status.classList.toggle("missed", missed);
  };
  store.subscribe(["figures"], ({ figures, ...settings }) => {
    // While an orbit is held, the still is rendered without a budget.
    if (figures?.kind === "still" && figures.bound && !settings.playing) show(budgetStatus(figures, settings));
  });
  store.subscribe(["shows"], ({ shows }) => shows === "" && show({ missed: false, text: "" }));
  store.subscribe(["plan"], ({ plan }) => ($("drop-plan").hidden = !plan));
}
