// Settings of a link that the service rejects.

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

// Returns {settings, label} for the rejected settings: the defaults to set instead and that action in words.
// Returns null if the error names none of them.
export function refused_of(error, state) {
  const of_plan = new URLSearchParams(state.plan);
  const names = places_of(error)
    .map(({ pointer }) => pointer?.split("/").at(-1))
    .map((key) => (of_plan.has(key) ? "plan" : kSettings[key]))
    .filter((name) => name && state[name] !== kDefaults[name]);
  if (names.length === 0) return null;
  return { settings: Object.fromEntries(names.map((name) => [name, kDefaults[name]])), label: kWaysOut[names[0]] };
}
