// Requests under 64 KiB that cause as much work as possible.

import { readFileSync } from "node:fs";
import { many_attributes_exr, put_asset, text_png, tiny_jpeg } from "./pictures.mjs";
import { kLayers, kPaper } from "./support.mjs";

const kGlass = { type: "refractive", ior: 1.5, fresnel: "exact" };
const kMirror = { type: "reflective", n: [0.2, 0.9, 1.1], k: [3.9, 2.4, 2.2] };
const kSun = { type: "directional", from: [0.4, 1, 0.6], intensity: [1, 1, 1] };

// Returns a scene of one material, seen from the front. `number` makes the scene new to the service.
function scene_of(number, material, objects, { depth = 5, side = 64, samples = 1, lights = [kSun], ...more }) {
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

const many_lights = Array.from({ length: 700 }, (_, i) => ({
  type: "point",
  position: [Math.round(9 * Math.cos(i)), 5 + (i % 7), Math.round(9 * Math.sin(i))],
  intensity: [0.01, 0.01, 0.01],
}));

const kRough = { type: "rough", kd: [0.5, 0.5, 0.5] };
const tiny_model = { ball: { objects: [sphere(1)] } };
const coincident_instances = Array.from({ length: 2000 }, () => ({ model: "ball" }));
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
function grid_mesh(n) {
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

const paper = JSON.parse(readFileSync(kPaper));
const paper_of = (number, more) => ({ ...paper, title: `attack ${number}`, ...more });
const square = (side, samples = 1) => ({
  image: { width: side, height: side },
  render: { ...paper.render, samples },
});

const glass_of = (depth, count) => [
  `glass, ${count} shells, depth ${depth}`,
  (n) => render(scene_of(n, kGlass, shells(count), { depth })),
];
const many_of = (name, material, objects, more = {}, options = {}) => [
  name,
  (n) => render(scene_of(n, material, objects, more), options),
];
const structures = ["list", "boxes", "obb-tree", "octree", "kd-sah", "adaptive-grid"];

// Returns an attack on a scene that is posted first. `ask` gets its id.
const of_scene = (name, scene, ask) => [name, ask, scene];

const kNumbers = `[${Array(15_000).fill("[0]").join(",")}]`;
const post = (path, body) => ({ method: "POST", path, body: typeof body === "string" ? body : JSON.stringify(body) });
const sphere_of = (number, material) => scene_of(number, material, [sphere(1)], {});

// Requests that need no render slot, and files for decoders. These attacks also run with 180 clients at once.
const kSmall = [
  ["the catalog", () => ({ path: "/v1/catalog" })],
  ["the description of the service", () => ({ path: "/openapi.json" })],
  [
    "explanations",
    (n, id) => ({ path: `/v1/scenes/${id}/explain?seed=${n}` }),
    (n) => scene_of(n, kGlass, shells(12), { depth: 32 }),
  ],
  ["a long wrong name", (n) => post("/v1/scenes", sphere_of(n, { type: "r".repeat(60_000) }))],
  [
    "many wrong names",
    (n) =>
      post("/v1/scenes", {
        ...sphere_of(n, kRough),
        ...Object.fromEntries(Array.from({ length: 4000 }, (_, i) => [`x${i}`, 0])),
      }),
  ],
  ["shares of many numbers", () => post("/v1/shares", kNumbers)],
  [
    "jobs of one pixel",
    (n) => post("/v1/jobs", { scene: { ...sphere_of(n, kRough), image: { width: 1, height: 1 } } }),
  ],
  ["JPEGs of 362 bytes", (n) => put_asset(tiny_jpeg(n))],
  ["JPEGs of many scans", (n) => put_asset(tiny_jpeg(n, 60))],
  ["PNGs of long texts", (n) => put_asset(text_png(n))],
  ["EXRs of many attributes", (n) => put_asset(many_attributes_exr(n))],
].map(([name, ask, scene]) => [name, ask, scene, 180]);

// Attacks: [name, request(number, id), scene(number) that provides the id, clients of additional runs].
export const kAttacks = [
  ...[4, 8, 12, 16, 24, 32].map((depth) => glass_of(depth, 2)),
  ...[16, 32].map((depth) => glass_of(depth, 12)),
  many_of("glass of many samples", kGlass, shells(2), { depth: 32, samples: 1400 }),
  many_of("glass of many pixels", kGlass, shells(2), { depth: 32, side: 2400 }),
  many_of("glass of EXR layers", kGlass, shells(2), { depth: 32, side: 2000 }, kLayers),
  many_of("small pictures of EXR layers", kRough, shells(2), { side: 380 }, kLayers),
  many_of("mirrors that face each other", kMirror, hall, { depth: 32, side: 2000 }),
  many_of("mirrors, many samples", kMirror, hall, { depth: 32, samples: 4096 }),
  many_of("many lights", kRough, hall, { lights: many_lights, side: 500 }),
  many_of("many lights in glass", kGlass, shells(4), { lights: many_lights, depth: 32 }),
  many_of(
    "coincident spheres",
    kRough,
    Array.from({ length: 900 }, () => sphere(1)),
    { side: 1000 },
  ),
  many_of(
    "coincident glass spheres",
    kGlass,
    Array.from({ length: 900 }, () => sphere(1)),
    { depth: 32 },
  ),
  many_of("coincident instances", kRough, [], {
    models: tiny_model,
    instances: coincident_instances,
    side: 1000,
  }),
  many_of("coincident glass instances", kGlass, [], {
    models: tiny_model,
    instances: coincident_instances,
    depth: 32,
  }),
  many_of("needles", kRough, needles, { side: 2000 }),
  many_of("needles of glass", kGlass, needles, { depth: 32, side: 500 }),
  many_of("a mesh", kRough, [grid_mesh(24)], { side: 4096 }),
  many_of("a mesh of glass", kGlass, [grid_mesh(24)], { depth: 32, side: 500 }),
  ...structures.map((name) =>
    many_of(`a mesh by ${name}`, kGlass, [grid_mesh(24)], { depth: 12, side: 500 }, { accelerator: name }),
  ),
  many_of("sampled and predicted", kGlass, shells(4), { depth: 16 }, { prediction: "network", reorder: true }),
  many_of("in double precision", kGlass, shells(2), { depth: 32 }, { precision: "double" }),
  many_of("what moves", kGlass, [], { models: tiny_model, instances: moving, depth: 16, side: 500 }),
  ["large pictures", (n) => render(paper_of(n, square(4096)))],
  ["pictures of many samples", (n) => render(paper_of(n, square(600, 256)))],
  ["small pictures", (n) => render(paper_of(n, square(64)))],
  ["scenes that are kept", (n) => ({ method: "POST", path: "/v1/scenes", body: JSON.stringify(paper_of(n, {})) })],
  ["bodies that are no JSON", () => ({ method: "POST", path: "/v1/render", body: "[".repeat(60_000) })],
  of_scene(
    "frames of glass",
    (n) => scene_of(n, kGlass, shells(2), { depth: 32 }),
    (n, id) => ({ path: `/v1/scenes/${id}/frame.png?seed=${n}&width=256&height=256` }),
  ),
  of_scene(
    "an orbit of glass",
    (n) => scene_of(n, kGlass, shells(2), { depth: 32 }),
    (n, id) => ({ path: `/v1/scenes/${id}/orbit?seed=${n}&fps=0` }),
  ),
  of_scene(
    "an orbit of large pictures",
    (n) => paper_of(n, {}),
    (n, id) => ({ path: `/v1/scenes/${id}/orbit?seed=${n}&fps=0&width=4000&height=4000` }),
  ),
  of_scene(
    "a chart of glass",
    (n) => scene_of(n, kGlass, shells(2), { depth: 24 }),
    (n, id) => ({ method: "POST", path: `/v1/scenes/${id}/charts`, body: JSON.stringify({ render: { seed: n } }) }),
  ),
  [
    "jobs of glass",
    (n) => ({
      method: "POST",
      path: "/v1/jobs",
      body: JSON.stringify({
        scene: scene_of(n, kGlass, shells(2), { depth: 32 }),
        orbit: { frames: 100 },
      }),
    }),
  ],
  ...kSmall,
];
