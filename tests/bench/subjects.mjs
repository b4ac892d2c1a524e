// Generated scenes of different kinds for measurements of structures.

import { copyFileSync, existsSync, mkdirSync, writeFileSync } from "node:fs";
import { runCommand } from "./command.mjs";

export const FOLDER = "build/bench-scenes";

// Returns a generator of numbers in [0, 1), determined by `seed` (mulberry32).
export function randomNumbers(seed) {
  let state = seed;
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

// Returns a lit scene of `objects`, seen from `eye`.
export function sceneOf(title, objects, eye, lookAt = [0, 0, 0]) {
  return {
    version: 1,
    title,
    camera: { type: "perspective", eye, look_at: lookAt, fov_degrees: 45 },
    image: { width: 512, height: 512 },
    ambient: [0.3, 0.3, 0.3],
    background: [0.5, 0.6, 0.8],
    materials: {
      chalk: { type: "rough", kd: [0.7, 0.7, 0.7], ks: [0, 0, 0] },
      steel: { type: "reflective", n: [2.5, 2.5, 2.5], k: [3.3, 3.3, 3.3] },
    },
    lights: [
      { type: "directional", from: [1, 2, 1.5], intensity: [0.6, 0.6, 0.6] },
      { type: "directional", from: [-2, 1, 0.5], intensity: [0.4, 0.4, 0.4] },
    ],
    objects,
    render: { max_depth: 3 },
  };
}

// Writes a binary PLY file. `vertex(i)` and `triangle(i)` return three numbers each.
function writePly(path, vertices, vertex, triangles, triangle) {
  const head =
    "ply\nformat binary_little_endian 1.0\n" +
    `element vertex ${vertices}\nproperty float x\nproperty float y\nproperty float z\n` +
    `element face ${triangles}\nproperty list uchar int vertex_indices\nend_header\n`;
  const bytes = Buffer.allocUnsafe(head.length + 12 * vertices + 13 * triangles);
  let at = bytes.write(head, "latin1");
  for (let i = 0; i < vertices; ++i) for (const x of vertex(i)) at = bytes.writeFloatLE(x, at);
  for (let i = 0; i < triangles; ++i) {
    at = bytes.writeUInt8(3, at);
    for (const corner of triangle(i)) at = bytes.writeInt32LE(corner, at);
  }
  writeFileSync(path, bytes);
}

// Writes a closed sphere of about `triangles` triangles, with bumps of several sizes.
function writeBumpySphere(path, triangles, radius) {
  const side = Math.max(3, Math.round(Math.sqrt(triangles / 2)));
  const vertex = (i) => {
    const polar = (Math.PI * Math.floor(i / side)) / side,
      around = (2 * Math.PI * (i % side)) / side;
    const bumps =
      0.1 * Math.sin(5 * polar) * Math.cos(4 * around) +
      0.03 * Math.sin(31 * polar) * Math.cos(24 * around) +
      0.01 * Math.cos(83 * polar + 40 * around);
    const r = radius * (1 + bumps * Math.sin(polar));
    return [r * Math.sin(polar) * Math.cos(around), r * Math.cos(polar), r * Math.sin(polar) * Math.sin(around)];
  };
  const triangle = (i) => {
    const square = i >> 1,
      row = Math.floor(square / side),
      column = square % side,
      next = (column + 1) % side;
    const a = row * side + column,
      b = row * side + next,
      c = a + side,
      d = b + side;
    return i % 2 === 0 ? [a, b, c] : [b, d, c];
  };
  writePly(path, side * (side + 1), vertex, 2 * side * side, triangle);
}

// Functions that make the subjects and may write files to FOLDER. Each returns the scene, the path of a scene
// to copy, null if they have written <name>.json, or undefined if a file is missing.
const SUBJECTS = {
  few: () => "scenes/glass.json",
  flake: () => {
    runCommand(["node", "scenes/generate-sphereflake.mjs", "4", `${FOLDER}/flake.json`]);
    return null;
  },
  cloud: () => {
    const random = randomNumbers(1),
      at = () => 8 * random() - 4;
    const ball = (i) => ({
      type: "sphere",
      center: [at(), at(), at()],
      radius: 0.05 + 0.1 * random(),
      material: i % 4 ? "chalk" : "steel",
    });
    return sceneOf(
      "A cloud of 8,000 balls",
      Array.from({ length: 8000 }, (_, i) => ball(i)),
      [0, 0, 13],
    );
  },
  stadium: () => {
    writeBumpySphere(`${FOLDER}/stadium-teapot.ply`, 10_000, 0.5);
    const objects = [{ type: "mesh", file: "stadium-teapot.ply", material: "steel" }];
    const ring = 300;
    const place = (i, radius, y) => {
      const angle = (2 * Math.PI * i) / ring;
      return [radius * Math.cos(angle), y, radius * Math.sin(angle)];
    };
    for (let row = 0; row < 4; ++row)
      for (let i = 0; i < ring; ++i) {
        const low = 400 + 25 * row,
          y = 15 * row - 20;
        const [a, b] = [place(i, low, y), place(i + 1, low, y)];
        const [c, d] = [place(i, low + 25, y + 15), place(i + 1, low + 25, y + 15)];
        objects.push({ type: "triangle", vertices: [a, b, c], material: "chalk" });
        objects.push({ type: "triangle", vertices: [b, d, c], material: "chalk" });
      }
    return sceneOf("A teapot in a stadium", objects, [1.2, 0.8, 1.8]);
  },
  needles: () => {
    const random = randomNumbers(3),
      at = (size) => size * (2 * random() - 1);
    const needle = () => {
      const from = [at(3), at(3), at(3)],
        along = [at(2), at(2), at(2)];
      return [from, from.map((x, k) => x + along[k]), from.map((x) => x + at(0.02))];
    };
    const objects = Array.from({ length: 6000 }, () => ({ type: "triangle", vertices: needle(), material: "chalk" }));
    return sceneOf("6,000 long thin triangles", objects, [0, 0, 11]);
  },
  bumpy: () => {
    writeBumpySphere(`${FOLDER}/bumpy.ply`, 70_000, 1);
    const objects = [
      { type: "mesh", file: "bumpy.ply", material: "chalk" },
      { type: "plane", point: [0, -1.2, 0], normal: [0, 1, 0], material: "steel" },
    ];
    return sceneOf("A bumpy ball of 70,000 triangles", objects, [0.7, 0.9, 3]);
  },
  bunny: () => {
    const from = `${process.env.BENCH_MESHES}/stanford-bunny.obj`;
    if (!process.env.BENCH_MESHES || !existsSync(from)) return undefined;
    copyFileSync(from, `${FOLDER}/bunny.obj`);
    const objects = [
      { type: "mesh", file: "bunny.obj", material: "chalk" },
      { type: "plane", point: [0, 0.033, 0], normal: [0, 1, 0], material: "steel" },
    ];
    return sceneOf("The Stanford bunny", objects, [-0.05, 0.2, 0.3], [-0.02, 0.1, 0]);
  },
};

// Writes a bumpy ball of about `triangles` triangles. Returns the path of the scene.
export function writeBall(triangles) {
  mkdirSync(FOLDER, { recursive: true });
  const name = `ball-${triangles}`,
    path = `${FOLDER}/${name}.json`;
  writeBumpySphere(`${FOLDER}/${name}.ply`, triangles, 1);
  const objects = [{ type: "mesh", file: `${name}.ply`, material: "chalk" }];
  writeFileSync(path, JSON.stringify(sceneOf(`A ball of ${triangles} triangles`, objects, [0.7, 0.9, 3])));
  return path;
}

// Writes all subjects. Returns [name, path] of each written subject.
export function writeSubjects() {
  mkdirSync(FOLDER, { recursive: true });
  const written = [];
  for (const [name, make] of Object.entries(SUBJECTS)) {
    const path = `${FOLDER}/${name}.json`,
      made = make();
    if (made === undefined) {
      console.error(`${name} skipped: its file is missing in the folder BENCH_MESHES`);
      continue;
    }
    if (typeof made === "string") copyFileSync(made, path);
    else if (made !== null) writeFileSync(path, JSON.stringify(made));
    written.push([name, path]);
  }
  return written;
}
