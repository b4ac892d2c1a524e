// Compares the cost of an error budget with the cheapest settings of a grid that meet the error. Costs are in
// rays, which do not depend on the machine. Errors are in display values.

import { spawnSync } from "node:child_process";
import { ORRERY } from "./command.mjs";
import { median, showProgress } from "./measure.mjs";

const SCENES = [
  "paper",
  "glass",
  "mirrors",
  "orrery",
  "material-rough",
  "material-glass",
  "light-many",
  "sphereflake-2",
  "cornell-box",
  "technique-distributed",
];
const ERRORS = [0.1, 0.07, 0.05, 0.035, 0.025, 0.018],
  SIZE = 160;
const SAMPLES = [2, 4, 6, 8, 10, 12, 16, 20, 24, 32, 48, 64, 96, 128];
const CONTRIBUTIONS = [0.04, 0.01, 0.0025, 6e-4, 4e-5]; // minimum contributions of rays, for ray trees

function render(scene, size, options) {
  const words = Object.entries({ width: size, height: size, ...options }).flatMap(([name, value]) => [
    `--${name}`,
    String(value),
  ]);
  const done = spawnSync(ORRERY, ["render", `scenes/${scene}.json`, "--stats=json", ...words], { encoding: "utf8" });
  if (done.status !== 0) throw new Error(`${scene}: ${done.stderr.trim()}`);
  return JSON.parse(done.stdout);
}

// Returns {rays, bound} of each setting of the grid, up to the first sample count that meets the smallest
// error.
function gridOf(scene, size) {
  const isTree = render(scene, 32, {}).technique === "whitted",
    cells = [];
  for (const samples of SAMPLES) {
    for (const contribution of isTree ? CONTRIBUTIONS : [0]) {
      const { rays, certificate } = render(scene, size, {
        samples,
        space: "display",
        precision: "double",
        "max-depth": 32,
        "min-contribution": contribution,
      });
      cells.push({ rays: rays.total, bound: certificate.total.rms ?? Infinity });
    }
    if (cells.some(({ bound }) => bound <= ERRORS.at(-1))) break;
  }
  return cells;
}

const line = (values) => values.map((v, i) => (i === 0 ? v.padEnd(24) : String(v).padStart(12))).join("");

export const BUDGETS = {
  name: "budgets",
  what: "cost of an error budget relative to the cheapest settings that meet the error",
  needs: [ORRERY],
  run({ size = SIZE }) {
    const ratios = [];
    console.log(line(["scene", "error", "met", "rays", "min rays", "ratio"]));
    for (const scene of SCENES) {
      showProgress(`budgets: ${scene}`);
      const cells = gridOf(scene, size);
      for (const error of ERRORS) {
        const { rays, budget } = render(scene, size, { error });
        const least = Math.min(...cells.filter(({ bound }) => bound <= error).map((cell) => cell.rays));
        const ratio = budget.met && isFinite(least) ? rays.total / least : null;
        if (ratio) ratios.push(ratio);
        console.log(
          line([scene, error, budget.met, rays.total, isFinite(least) ? least : "-", ratio?.toFixed(2) ?? "-"]),
        );
      }
    }
    showProgress("");
    console.log(
      `${ratios.length} of ${SCENES.length * ERRORS.length} met: median ${median(ratios).toFixed(2)}, ` +
        `max ${Math.max(...ratios).toFixed(2)}`,
    );
    return [];
  },
};
