// Compares views of a model with f3d and Blender, and the reading of large models with assimp.

import { spawn } from "node:child_process";
import { once } from "node:events";
import { cpuRun, ORRERY } from "./command.mjs";
import { FORMATS, modelFile } from "./model_files.mjs";
import { FOLDER } from "./subjects.mjs";

const SIDE = 512; // pixels
const DISPLAY = ":97";
const VIEWED = 100_000,
  READ = 1_000_000; // triangles

// f3d needs a display. The CPU time of the display does not count.
async function startDisplay() {
  const display = spawn("Xvfb", [DISPLAY, "-screen", "0", "1024x768x24"], { stdio: ["ignore", "ignore", "pipe"] });
  const failed = once(display, "exit").then(() => Promise.reject(new Error(`Xvfb ${DISPLAY} ended`)));
  await Promise.race([new Promise((done) => setTimeout(done, 2000)), failed]);
  failed.catch(() => {});
  return display;
}

const ours = (model) => cpuRun([ORRERY, "view", model, "-o", `${FOLDER}/view.png`]);
const VIEWS = [
  {
    name: "view-f3d",
    what: `view of 100,000 triangles, ${SIDE}x${SIDE}: f3d (rasterized without shadows) and orrery (path traced)`,
    cost: "CPU s",
    reach: 3,
    aim: 6,
    needs: ["f3d", "Xvfb"],
    start: async () => {
      const model = modelFile("ply", VIEWED),
        display = await startDisplay();
      const theirs = ["env", `DISPLAY=${DISPLAY}`, "f3d", model, "--output", `${FOLDER}/f3d.png`];
      return {
        ours: () => ours(model),
        theirs: () => cpuRun([...theirs, "--resolution", `${SIDE},${SIDE}`]),
        stop: () => display.kill(),
      };
    },
  },
  {
    name: "view-blender",
    what: `view of 100,000 triangles, ${SIDE}x${SIDE}: Blender (Cycles, 4 samples per pixel) and orrery`,
    cost: "CPU s",
    reach: 10,
    aim: 30,
    needs: ["blender"],
    start: () => {
      const model = modelFile("glb", VIEWED);
      const order = {
        model,
        camera: { eye: [2, 2, 4], look_at: [0, 0, 0], up: [0, 1, 0], fov_degrees: 30 },
        light: { intensity: [0.7], direction_to_light: [-1, 2, 1], angle_degrees: 15 },
        radiance: [0.5, 0.5, 0.5],
        samples: 4,
        side: SIDE,
        file: `${process.cwd()}/${FOLDER}/blender.png`,
      };
      const theirs = ["blender", "-b", "--factory-startup", "-P", "tests/meshes/cycles_view.py"];
      return { ours: () => ours(model), theirs: () => cpuRun([...theirs, "--", JSON.stringify(order)]) };
    },
  },
];

const readers = (format) => ({
  name: `read-${format}`,
  what: `reading a million triangles (${format}): assimp info --raw and orrery inspect, which also welds and checks`,
  cost: "CPU s",
  reach: 1,
  aim: null,
  needs: ["assimp"],
  start: () => {
    const model = modelFile(format, READ);
    return {
      ours: () => cpuRun([ORRERY, "inspect", model]),
      theirs: () => cpuRun(["assimp", "info", model, "--raw"]),
    };
  },
});

export const MODELS = [...VIEWS, ...FORMATS.map(readers)];
