#!/usr/bin/env node
// Renders glTF models with `orrery view` and with Cycles of Blender, with the same camera and the same lights, and
// arranges both images side by side.
//
//   node tests/meshes/cycles_compare.mjs SHEET.jpg MODEL...     prints the RMS difference of the codes, divided by 255

import { execFileSync } from "node:child_process";

import { compareSideBySide, kSide } from "./side_by_side.mjs";

const [sheet, ...models] = process.argv.slice(2);
if (models.length === 0) {
  console.error("usage: node tests/meshes/cycles_compare.mjs SHEET.jpg MODEL...");
  process.exit(2);
}
await compareSideBySide(sheet, models, (model, { camera, lights, environment }, file) => {
  const order = JSON.stringify({
    model,
    camera,
    light: lights[0],
    radiance: environment.radiance,
    samples: 128,
    side: kSide,
    file,
  });
  execFileSync("blender", ["-b", "--factory-startup", "-P", "tests/meshes/cycles_view.py", "--", order], {
    stdio: ["ignore", "ignore", "inherit"],
  });
});
