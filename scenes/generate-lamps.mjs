#!/usr/bin/env node
// Writes a scene with COUNT lamps to FILE, or to standard output:  node scenes/generate-lamps.mjs COUNT [FILE]
//
// The lamps are glowing balls over a dark floor, in the order of a sunflower's seeds (Vogel, "A Better Way to
// Construct the Sunflower Head", 1979). They shrink as COUNT grows, so that their total emission stays the
// same. There are columns, and a light of every other kind: the moon, a tube, a point light and a spot.
import { writeFileSync } from "node:fs";

const kRadius = 9; // radius of the field, metres
const kHues = [
  [2.4, 0.7, 0.14],
  [2.4, 1.2, 0.3],
  [2, 1.7, 1.1],
  [0.5, 1.3, 2.3],
  [0.8, 0.45, 2.3],
  [2.1, 0.3, 1.1],
];
const round = (x) => Number(x.toFixed(4)) + 0;

function lamps(count) {
  const radius = 1.3 / Math.sqrt(count);
  return Array.from({ length: count }, (_, i) => {
    const out = Math.sqrt((i + 0.5) / count),
      turn = i * Math.PI * (3 - Math.sqrt(5));
    const height = radius + 0.35 * (1 + Math.sin(9 * out + (2 * turn) / (1 + out)));
    return {
      type: "sphere",
      center: [kRadius * out * Math.cos(turn), height, kRadius * out * Math.sin(turn)].map(round),
      radius: round(radius),
      material: `lamp-${Math.floor(out * out * kHues.length)}`,
    };
  });
}

const columns = [
  [-2.4, 0.5, 2.2],
  [1.6, 1.4, 2.8],
  [3.4, -2.6, 3.4],
  [-3.6, -3.4, 3.8],
  [0.2, -4.6, 4.4],
].map(([x, z, height]) => ({
  type: "cylinder",
  base: [x, 0, z],
  top: [x, height, z],
  radius: 0.42,
  material: "stone",
}));

function scene(count) {
  const materials = {
    floor: { type: "oren-nayar", reflectance: [0.3, 0.3, 0.33], roughness: 0.5 },
    stone: { type: "lambert", reflectance: [0.72, 0.7, 0.66] },
  };
  kHues.forEach((emission, i) => {
    materials[`lamp-${i}`] = { type: "lambert", reflectance: 0, emission };
  });
  return {
    version: 1,
    title: `${count} lamps`,
    description: "Small lamps and lights of all types. Each path vertex samples one by its estimated contribution.",
    camera: { type: "perspective", eye: [0, 4.2, 11.5], look_at: [0, 0.7, -0.6], fov_degrees: 44 },
    image: { width: 720, height: 450 },
    background: [0.002, 0.003, 0.007],
    materials,
    lights: [
      { type: "directional", direction_to_light: [-3, 4, 2], intensity: [0.012, 0.016, 0.03], angle_degrees: 0.5 },
      { type: "line", from: [-6, 0.08, -6.5], to: [6, 0.08, -6.5], intensity_per_metre: [0.5, 0.25, 0.6] },
      { type: "point", position: [0, 1.2, 3.4], intensity: [0.5, 0.35, 0.2], attenuation: [0, 0, 1] },
      {
        type: "spot",
        position: [6.5, 5, 3],
        direction: [-5, -5, -1.6],
        intensity: [3, 3.6, 4],
        attenuation: [0, 0, 1],
        inner_degrees: 8,
        outer_degrees: 16,
      },
    ],
    objects: [{ type: "plane", point: [0, 0, 0], normal: [0, 1, 0], material: "floor" }, ...columns, ...lamps(count)],
    render: { technique: "path", max_depth: 4, samples: 64 },
  };
}

const [count, file] = process.argv.slice(2);
if (!(Number.isInteger(Number(count)) && count >= 1)) {
  console.error("usage: node scenes/generate-lamps.mjs COUNT [FILE]");
  process.exit(2);
}
const { objects, ...rest } = scene(Number(count));
const lines = objects.map((object) => `    ${JSON.stringify(object)}`).join(",\n");
writeFileSync(
  file ?? process.stdout.fd,
  `${JSON.stringify(rest, null, 1).slice(0, -2)},\n "objects": [\n${lines}\n ]\n}\n`,
);
