// Budget buttons for the picture at rest, and the text that reports the outcome.

import { bound_words, budget_words, fields_of, parameters_of } from "./bound.js";

// Attaches `chips`, buttons with data-seconds or data-error. A click calls `on_change({seconds, error})`, 0
// for no budget. Returns a function that marks the button of a state.
export function attach_budgets(chips, on_change) {
  for (const chip of chips) {
    chip.addEventListener("click", () => {
      const chosen = chip.getAttribute("aria-pressed") !== "true";
      on_change(chosen ? budget_of(chip) : { seconds: 0, error: 0 });
    });
  }
  return ({ seconds, error }) => {
    for (const chip of chips) {
      const budget = budget_of(chip);
      chip.setAttribute("aria-pressed", String(budget.seconds === seconds && budget.error === error));
    }
  };
}

export const budget_of = ({ dataset }) => ({ seconds: Number(dataset.seconds ?? 0), error: Number(dataset.error ?? 0) });

// Returns {missed, text} for a picture made with a plan or a budget. `figures` are the picture's.
export function told_of(figures, { plan, seconds, error }) {
  const { budget, bound } = figures;
  const fields = typeof bound === "object" && bound ? fields_of(bound) : parameters_of(bound);
  if (seconds || error) return budget_words({ ...(budget ? parameters_of(budget) : { reason: "the service does not say what became of it" }) }, fields);
  if (plan) return { missed: false, text: `Plan: ${plan.replaceAll("&", ", ").replaceAll("=", " ")}; ${bound_words(fields)}` };
  return { missed: false, text: "" };
}
