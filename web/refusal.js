// Settings of a link that the service rejects.

import { placesOf } from "./problem.js";
import { DEFAULTS } from "./link.js";

const SETTINGS = {
  technique: "technique",
  samples: "samples",
  width: "size",
  height: "size",
  seconds: "seconds",
  error: "error",
};
const RESET_LABELS = {
  technique: "Use the scene’s technique",
  samples: "Choose samples automatically",
  size: "Fit the image to the window",
  plan: "Reset to automatic",
  seconds: "Remove the time limit",
  error: "Remove the error limit",
};

// Returns {settings, label} for the rejected settings: their defaults, and the label of a button that sets
// them. Returns null if the error names no setting of the link.
export function rejectedSettings(error, current) {
  const ofPlan = new URLSearchParams(current.plan);
  const names = placesOf(error)
    .map(({ pointer }) => pointer?.split("/").at(-1))
    .map((key) => (ofPlan.has(key) ? "plan" : SETTINGS[key]))
    .filter((name) => name && current[name] !== DEFAULTS[name]);
  if (names.length === 0) return null;
  return { settings: Object.fromEntries(names.map((name) => [name, DEFAULTS[name]])), label: RESET_LABELS[names[0]] };
}
