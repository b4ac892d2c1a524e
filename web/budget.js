// Chips that set a budget for the picture at rest instead of a plan, and what is said of the picture then.

import { bound_words, budget_words, fields_of, parameters_of } from "./bound.js";

// `chips`: buttons with data-seconds or data-error. `on_change({seconds, error})`: 0 for none.
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

// What a picture that was made to a plan or a budget tells: {missed, text}; `figures` of the picture.
export function told_of(figures, { plan, seconds, error }) {
  const { budget, bound } = figures;
  const fields = typeof bound === "object" && bound ? fields_of(bound) : parameters_of(bound);
  if (seconds || error) return budget_words({ ...(budget ? parameters_of(budget) : { reason: "the service does not say what became of it" }) }, fields);
  if (plan) return { missed: false, text: `Plan: ${plan.replaceAll("&", ", ").replaceAll("=", " ")}; ${bound_words(fields)}` };
  return { missed: false, text: "" };
}
