// Attacks: requests with bodies of at most 64 KiB that cost the service as much time or memory as possible.

import { readFileSync } from "node:fs";
import { manyAttributesExr, putAsset, textPng, tinyJpeg } from "./pictures.mjs";
import { LAYERS, PAPER } from "./support.mjs";

const GLASS = { type: "refractive", ior: 1.5, fresnel: "exact" };
const MIRROR = { type: "reflective", n: [0.2, 0.9, 1.1], k: [3.9, 2.4, 2.2] };
const SUN = { type: "directional", from: [0.4, 1, 0.6], intensity: [1, 1, 1] };

// Returns a scene with a single material, seen from the front. `number` makes each scene different, so that
// the service cannot reuse results.
function sceneOf(number, material, objects, { depth = 5, side = 64, samples = 1, lights = [SUN], ...more }) {
  return {
    version: 1,
    title: `attack ${number}`,
    camera: { type: "perspective", eye: [0, 0, 4], look_at: [0, 0, 0], fov_degrees: 40 },
    image: { width: side, height: side },
    ambient: [0.1, 0.1, 0.1],
    materials: { m: material },
    lights,
    objects,
    render: { max_depth: depth, samples },
    ...more,
  };
}

const sphere = (radius, center = [0, 0, 0]) => ({ type: "sphere", center, radius, material: "m" });
const shells = (count) => Array.from({ length: count }, (_, i) => sphere(1.5 - (0.6 * i) / count));
const render = (scene, options = {}) => ({
  method: "POST",
  path: "/v1/render",
  headers: options.layers ? { Accept: "image/x-exr" } : {},
  body: JSON.stringify({ scene, render: options }),
});

// Two parallel mirror planes with a ball between them.
const hall = [
  { type: "plane", point: [0, 0, -3], normal: [0, 0, 1], material: "m" },
  { type: "plane", point: [0, 0, 5], normal: [0, 0, -1], material: "m" },
  sphere(0.8),
];

const manyLights = Array.from({ length: 700 }, (_, i) => ({
  type: "point",
  position: [Math.round(9 * Math.cos(i)), 5 + (i % 7), Math.round(9 * Math.sin(i))],
  intensity: [0.01, 0.01, 0.01],
}));

const ROUGH = { type: "rough", kd: [0.5, 0.5, 0.5] };
const tinyModel = { ball: { objects: [sphere(1)] } };
const coincidentInstances = Array.from({ length: 2000 }, () => ({ model: "ball" }));
const needles = Array.from({ length: 500 }, (_, i) => ({
  type: "triangle",
  vertices: [
    [-2, i / 1e6, 0],
    [2, i / 1e6, 0],
    [2, (i + 10) / 1e6, 1e-5],
  ],
  material: "m",
}));

// Returns a square mesh of n x n cells, two triangles each.
function gridMesh(n) {
  const positions = [];
  const indices = [];
  for (let y = 0; y <= n; ++y)
    for (let x = 0; x <= n; ++x) positions.push([(2 * x) / n - 1, (2 * y) / n - 1, ((x * y) % 3) / 10]);
  for (let y = 0; y < n; ++y)
    for (let x = 0; x < n; ++x) {
      const at = y * (n + 1) + x;
      indices.push([at, at + 1, at + n + 1], [at + 1, at + n + 2, at + n + 1]);
    }
  return { type: "mesh", positions, indices, material: "m" };
}

const moving = Array.from({ length: 300 }, (_, i) => ({
  model: "ball",
  translate: [i % 20, i / 20, -i],
  motion: [
    { time: 0, translate: [i % 20, i / 20, -i] },
    { time: 1, translate: [i % 7, i / 30, i % 5] },
  ],
}));

const paper = JSON.parse(readFileSync(PAPER));
const paperOf = (number, more) => ({ ...paper, title: `attack ${number}`, ...more });
const square = (side, samples = 1) => ({
  image: { width: side, height: side },
  render: { ...paper.render, samples },
});

const glassOf = (depth, count) => [
  `glass, ${count} shells, depth ${depth}`,
  (n) => render(sceneOf(n, GLASS, shells(count), { depth })),
];
const manyOf = (name, material, objects, more = {}, options = {}) => [
  name,
  (n) => render(sceneOf(n, material, objects, more), options),
];
const structures = ["list", "boxes", "obb-tree", "octree", "kd-sah", "adaptive-grid"];

// Returns an attack on a stored scene. `ask(number, id)` returns the request for the scene's id.
const ofScene = (name, scene, ask) => [name, ask, scene];

const NUMBERS = `[${Array(15_000).fill("[0]").join(",")}]`;
const post = (path, body) => ({ method: "POST", path, body: typeof body === "string" ? body : JSON.stringify(body) });
const sphereOf = (number, material) => sceneOf(number, material, [sphere(1)], {});

// Requests without a render slot, and image files that are expensive to decode. These attacks also run with
// 180 concurrent clients.
const SMALL = [
  ["catalog", () => ({ path: "/v1/catalog" })],
  ["OpenAPI document", () => ({ path: "/openapi.json" })],
  [
    "scene explanations",
    (n, id) => ({ path: `/v1/scenes/${id}/explain?seed=${n}` }),
    (n) => sceneOf(n, GLASS, shells(12), { depth: 32 }),
  ],
  ["long unknown name", (n) => post("/v1/scenes", sphereOf(n, { type: "r".repeat(60_000) }))],
  [
    "many unknown names",
    (n) =>
      post("/v1/scenes", {
        ...sphereOf(n, ROUGH),
        ...Object.fromEntries(Array.from({ length: 4000 }, (_, i) => [`x${i}`, 0])),
      }),
  ],
  ["shares with many numbers", () => post("/v1/shares", NUMBERS)],
  ["jobs of one pixel", (n) => post("/v1/jobs", { scene: { ...sphereOf(n, ROUGH), image: { width: 1, height: 1 } } })],
  ["JPEGs of 362 bytes", (n) => putAsset(tinyJpeg(n))],
  ["JPEGs with many scans", (n) => putAsset(tinyJpeg(n, 60))],
  ["PNGs with long texts", (n) => putAsset(textPng(n))],
  ["EXRs with many attributes", (n) => putAsset(manyAttributesExr(n))],
].map(([name, ask, scene]) => [name, ask, scene, 180]);

// Attacks: [name, request(number, id), scene(number), count]. The service's id of the scene is passed to
// request(). `count`: number of clients of additional runs. `scene` and `count` are optional.
export const ATTACKS = [
  ...[4, 8, 12, 16, 24, 32].map((depth) => glassOf(depth, 2)),
  ...[16, 32].map((depth) => glassOf(depth, 12)),
  manyOf("glass, many samples", GLASS, shells(2), { depth: 32, samples: 1400 }),
  manyOf("glass, many pixels", GLASS, shells(2), { depth: 32, side: 2400 }),
  manyOf("glass, EXR layers", GLASS, shells(2), { depth: 32, side: 2000 }, LAYERS),
  manyOf("small images, EXR layers", ROUGH, shells(2), { side: 380 }, LAYERS),
  manyOf("facing mirrors", MIRROR, hall, { depth: 32, side: 2000 }),
  manyOf("facing mirrors, many samples", MIRROR, hall, { depth: 32, samples: 4096 }),
  manyOf("many lights", ROUGH, hall, { lights: manyLights, side: 500 }),
  manyOf("glass, many lights", GLASS, shells(4), { lights: manyLights, depth: 32 }),
  manyOf(
    "coincident spheres",
    ROUGH,
    Array.from({ length: 900 }, () => sphere(1)),
    { side: 1000 },
  ),
  manyOf(
    "coincident glass spheres",
    GLASS,
    Array.from({ length: 900 }, () => sphere(1)),
    { depth: 32 },
  ),
  manyOf("coincident instances", ROUGH, [], {
    models: tinyModel,
    instances: coincidentInstances,
    side: 1000,
  }),
  manyOf("coincident glass instances", GLASS, [], {
    models: tinyModel,
    instances: coincidentInstances,
    depth: 32,
  }),
  manyOf("needles", ROUGH, needles, { side: 2000 }),
  manyOf("glass needles", GLASS, needles, { depth: 32, side: 500 }),
  manyOf("mesh", ROUGH, [gridMesh(24)], { side: 4096 }),
  manyOf("glass mesh", GLASS, [gridMesh(24)], { depth: 32, side: 500 }),
  ...structures.map((name) =>
    manyOf(`glass mesh, accelerator ${name}`, GLASS, [gridMesh(24)], { depth: 12, side: 500 }, { accelerator: name }),
  ),
  manyOf("glass, prediction and reordering", GLASS, shells(4), { depth: 16 }, { prediction: "network", reorder: true }),
  manyOf("glass, double precision", GLASS, shells(2), { depth: 32 }, { precision: "double" }),
  manyOf("moving glass instances", GLASS, [], { models: tinyModel, instances: moving, depth: 16, side: 500 }),
  ["large images", (n) => render(paperOf(n, square(4096)))],
  ["images with many samples", (n) => render(paperOf(n, square(600, 256)))],
  ["small images", (n) => render(paperOf(n, square(64)))],
  ["stored scenes", (n) => ({ method: "POST", path: "/v1/scenes", body: JSON.stringify(paperOf(n, {})) })],
  ["deeply nested JSON", () => ({ method: "POST", path: "/v1/render", body: "[".repeat(60_000) })],
  ofScene(
    "glass, frames",
    (n) => sceneOf(n, GLASS, shells(2), { depth: 32 }),
    (n, id) => ({ path: `/v1/scenes/${id}/frame.png?seed=${n}&width=256&height=256` }),
  ),
  ofScene(
    "glass, orbit",
    (n) => sceneOf(n, GLASS, shells(2), { depth: 32 }),
    (n, id) => ({ path: `/v1/scenes/${id}/orbit?seed=${n}&fps=0` }),
  ),
  ofScene(
    "orbit of large images",
    (n) => paperOf(n, {}),
    (n, id) => ({ path: `/v1/scenes/${id}/orbit?seed=${n}&fps=0&width=4000&height=4000` }),
  ),
  ofScene(
    "glass, charts",
    (n) => sceneOf(n, GLASS, shells(2), { depth: 24 }),
    (n, id) => ({ method: "POST", path: `/v1/scenes/${id}/charts`, body: JSON.stringify({ render: { seed: n } }) }),
  ),
  [
    "glass, jobs",
    (n) => ({
      method: "POST",
      path: "/v1/jobs",
      body: JSON.stringify({
        scene: sceneOf(n, GLASS, shells(2), { depth: 32 }),
        orbit: { frames: 100 },
      }),
    }),
  ],
  ...SMALL,
];
