// BVHs that are refitted to moving objects, compared with rebuilt ones.

import { mkdirSync, writeFileSync } from "node:fs";
import { kFolder, random_numbers, scene_of } from "./subjects.mjs";
import { start_two_sided } from "./two_sided.mjs";

const kProgram = "build/motion";

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
  return scene_of("A waving sheet of 72,000 triangles", [mesh], [0, 2.5, 4]);
}

// Returns a scene with 4,000 balls, each of which flies to a different place.
function swarm() {
  const random = random_numbers(11),
    at = () => [0, 1, 2].map(() => 8 * random() - 4);
  const scene = scene_of(
    "4,000 balls that fly about",
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

const kSubjects = { cloth, swarm };

function path_of(subject) {
  mkdirSync(kFolder, { recursive: true });
  const path = `${kFolder}/${subject}.json`;
  writeFileSync(path, JSON.stringify(kSubjects[subject]()));
  return path;
}

function comparison(subject, what, words) {
  return {
    name: `motion-${subject}-${what}`,
    what: words,
    cost: "CPU s of one thread",
    reach: null,
    aim: null,
    needs: [kProgram],
    start: async () => {
      const { facts, ...sides } = await start_two_sided(kProgram, [path_of(subject), what]);
      const { frames, refitted, surface_area_growth, primitives } = facts;
      const remark =
        `${primitives} primitives; of ${frames} frames ${refitted} followed the one before; ` +
        `boxes at most ${surface_area_growth.toFixed(2)} times as large, relative to their contents, as when built`;
      return { ...sides, remark };
    },
  };
}

export const kMotion = [
  comparison("cloth", "ready", "a waving sheet: following the frame before, against building anew"),
  comparison("cloth", "rays", "the last frame of it: rays in the structure that followed, against a new one"),
  comparison("swarm", "ready", "balls that fly about: following or not, as it was decided, against building anew"),
  comparison("swarm", "rays", "the last frame of them: rays in the structure that followed, against a new one"),
];
