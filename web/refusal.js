// A refusal may name a setting that came with the link.

import { places_of } from "./problem.js";
import { kDefaults } from "./state.js";

const kSettings = {
  technique: "technique",
  samples: "samples",
  width: "size",
  height: "size",
  seconds: "seconds",
  error: "error",
};
const kWaysOut = {
  technique: "Use the scene’s own technique",
  samples: "Choose samples automatically",
  size: "Fit the window",
  plan: "Choose automatically",
  seconds: "Remove the time limit",
  error: "Remove the error limit",
};

// What of the state is refused: {settings, label}, the usual values to set instead and what that does in words; null
// where it is something else.
export function refused_of(error, state) {
  const of_plan = new URLSearchParams(state.plan);
  const names = places_of(error)
    .map(({ pointer }) => pointer?.split("/").at(-1))
    .map((key) => (of_plan.has(key) ? "plan" : kSettings[key]))
    .filter((name) => name && state[name] !== kDefaults[name]);
  if (names.length === 0) return null;
  return { settings: Object.fromEntries(names.map((name) => [name, kDefaults[name]])), label: kWaysOut[names[0]] };
}
