// Budget buttons for the picture at rest, and the text that reports the outcome.

import { boundText, budgetText, fieldsOf, parametersOf } from "./bound.js";

// Attaches `chips`, buttons with data-seconds or data-error. A click calls `onChange({seconds, error})`, 0
// for no budget.
export function attachBudgets(chips, store, onChange) {
  for (const chip of chips) {
    chip.addEventListener("click", () => {
      const chosen = chip.getAttribute("aria-pressed") !== "true";
      onChange(chosen ? budgetOf(chip) : { seconds: 0, error: 0 });
    });
  }
  store.subscribe(["seconds", "error"], ({ seconds, error }) => {
    for (const chip of chips) {
      const budget = budgetOf(chip);
      chip.setAttribute("aria-pressed", String(budget.seconds === seconds && budget.error === error));
    }
  });
}

export const budgetOf = ({ dataset }) => ({ seconds: Number(dataset.seconds ?? 0), error: Number(dataset.error ?? 0) });

// Returns {missed, text} for a picture rendered with a plan or a budget. The text is empty without either.
export function budgetStatus(figures, { plan, seconds, error }) {
  const { budget, bound } = figures;
  const fields = typeof bound === "object" && bound ? fieldsOf(bound) : parametersOf(bound);
  if (seconds || error)
    return budgetText({ ...(budget ? parametersOf(budget) : { reason: "no result reported" }) }, fields);
  if (plan)
    return {
      missed: false,
      text: `Settings: ${plan.replaceAll("&", ", ").replaceAll("=", " ")}; ${boundText(fields)}`,
    };
  return { missed: false, text: "" };
}
