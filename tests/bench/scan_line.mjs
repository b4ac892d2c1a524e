// Compares scan line techniques with ray casting: first image of a mesh of a million triangles. The scene has
// no light sources, so ray casting traces no shadow rays.

import { spawnSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { ORRERY } from "./command.mjs";
import { FOLDER, writeBall } from "./subjects.mjs";

const TRIANGLES = 1_000_000;
const SIZES = [
  [640, 480],
  [1280, 960],
];

function writeScene() {
  const scene = JSON.parse(readFileSync(writeBall(TRIANGLES), "utf8"));
  scene.lights = [];
  scene.objects[0].crease_degrees = 60;
  const path = `${FOLDER}/ball-scan-line.json`;
  writeFileSync(path, JSON.stringify(scene));
  return path;
}

// Renders an image. Its cost is the CPU time of the render: it builds the structure or projects the triangles,
// and traces or draws the image. Loading and encoding do not count.
function render(scene, technique, [width, height]) {
  const options = { technique, width, height, samples: 1 };
  const words = Object.entries(options).flatMap(([name, value]) => [`--${name}`, String(value)]);
  const done = spawnSync(ORRERY, ["render", scene, "--stats=json", ...words], { encoding: "utf8" });
  if (done.status !== 0) throw new Error(`${technique}: ${done.stderr.trim()}`);
  const { render_cpu_s: cpuS, rays } = JSON.parse(done.stdout);
  if (rays.total !== width * height) throw new Error(`${technique} traced rays other than camera rays`);
  return { cost: cpuS, cpuS };
}

let path = null;
function comparison(technique, size) {
  return {
    name: `scan-line-${technique}-${size[0]}`,
    what: `first image of a million triangles, ${size.join("x")}: ray casting (theirs) and ${technique} (ours)`,
    cost: "CPU s of the render",
    reach: 5,
    aim: null,
    needs: [],
    start: () => {
      path ??= writeScene();
      return { ours: () => render(path, technique, size), theirs: () => render(path, "raycast", size) };
    },
  };
}

export const SCAN_LINE = SIZES.flatMap((size) =>
  ["flat", "gouraud", "phong"].map((technique) => comparison(technique, size)),
);
