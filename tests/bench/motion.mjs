// Compares BVHs that are refitted to moving objects with rebuilt BVHs.

import { mkdirSync, writeFileSync } from "node:fs";
import { FOLDER, randomNumbers, sceneOf } from "./subjects.mjs";
import { startTwoSided } from "./two_sided.mjs";

const PROGRAM = "build/motion";

// Returns a scene with a waving sheet of 72,000 triangles.
function cloth() {
  const side = 190;
  const sheet = (phase) =>
    Array.from({ length: (side + 1) ** 2 }, (_, i) => {
      const x = (4 * (i % (side + 1))) / side - 2,
        z = (4 * Math.floor(i / (side + 1))) / side - 2;
      const y = 0.3 * Math.sin(2.5 * x + phase) * Math.cos(1.7 * z) + 0.02 * Math.sin(23 * x + 19 * z);
      return [x, y, z].map((value) => Number(value.toFixed(5)));
    });
  const square = (i) => {
    const a = Math.floor(i / side) * (side + 1) + (i % side);
    return [
      [a, a + 1, a + side + 2],
      [a, a + side + 2, a + side + 1],
    ];
  };
  const mesh = {
    type: "mesh",
    material: "chalk",
    positions: sheet(0),
    indices: Array.from({ length: side * side }, (_, i) => square(i)).flat(),
    motion: [{ time: 0 }, { time: 1, positions: sheet(2) }, { time: 2, positions: sheet(4) }],
  };
  return sceneOf("A waving sheet of 72,000 triangles", [mesh], [0, 2.5, 4]);
}

// Returns a scene with 4,000 balls, each of which moves to a different place.
function swarm() {
  const random = randomNumbers(11),
    at = () => [0, 1, 2].map(() => 8 * random() - 4);
  const scene = sceneOf(
    "4,000 moving balls",
    [{ type: "plane", point: [0, -5, 0], normal: [0, 1, 0], material: "chalk" }],
    [0, 0, 13],
  );
  const ball = { type: "sphere", center: [0, 0, 0], radius: 0.1, material: "chalk" };
  scene.models = { ball: { objects: [ball] } };
  scene.instances = Array.from({ length: 4000 }, () => ({
    model: "ball",
    motion: [
      { time: 0, translate: at() },
      { time: 1, translate: at() },
    ],
  }));
  return scene;
}

const SUBJECTS = { cloth, swarm };

function pathOf(subject) {
  mkdirSync(FOLDER, { recursive: true });
  const path = `${FOLDER}/${subject}.json`;
  writeFileSync(path, JSON.stringify(SUBJECTS[subject]()));
  return path;
}

function comparison(subject, what, words) {
  return {
    name: `motion-${subject}-${what}`,
    what: words,
    cost: "CPU s of one thread",
    reach: null,
    aim: null,
    needs: [PROGRAM],
    start: async () => {
      const { facts, ...sides } = await startTwoSided(PROGRAM, [pathOf(subject), what]);
      const { frames, refitted, surface_area_growth: surfaceAreaGrowth, primitives } = facts;
      const remark =
        `${primitives} primitives; ${refitted} of ${frames} frames refitted; ` +
        `relative surface area of boxes at most ${surfaceAreaGrowth.toFixed(2)} times the value after the build`;
      return { ...sides, remark };
    },
  };
}

export const MOTION = [
  comparison("cloth", "ready", "a waving sheet: refit for the last frame, compared with a rebuild"),
  comparison(
    "cloth",
    "rays",
    "a waving sheet: rays of the last frame in the refitted structure, compared with a rebuilt one",
  ),
  comparison("swarm", "ready", "moving balls: automatic refit or rebuild for the last frame, compared with a rebuild"),
  comparison(
    "swarm",
    "rays",
    "moving balls: rays of the last frame in the automatic structure, compared with a rebuilt one",
  ),
];
