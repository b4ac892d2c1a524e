#!/usr/bin/env node
// Renders model files with `orrery view` and arranges the images in one sheet (ImageMagick's montage).
//
//   node tests/meshes/contact_sheet.mjs SHEET.jpg FOLDER...    files below the folders, sorted by name

import { spawnSync } from "node:child_process";
import { mkdtempSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const kProgram = process.env.TEST_ORRERY ?? "build/orrery";
const kFormats = /\.(obj|ply|stl|3mf|gltf|glb)$/i;
const kSide = 160;

function* filesBelow(folder) {
  for (const entry of readdirSync(folder, { withFileTypes: true }).sort((a, b) => (a.name < b.name ? -1 : 1))) {
    const path = join(folder, entry.name);
    if (entry.isDirectory()) yield* filesBelow(path);
    else if (kFormats.test(entry.name)) yield path;
  }
}

const [sheet, ...folders] = process.argv.slice(2);
if (folders.length === 0) {
  console.error("usage: node tests/meshes/contact_sheet.mjs SHEET.jpg FOLDER...");
  process.exit(2);
}
const scratch = mkdtempSync(join(tmpdir(), "orrery-"));
const images = [];
let rejected = 0;
try {
  for (const file of folders.flatMap((folder) => [...filesBelow(folder)])) {
    const image = join(scratch, `${String(images.length).padStart(4, "0")}.png`);
    const size = [`--width=${kSide}`, `--height=${kSide}`, "--samples=16"];
    const { status, stderr } = spawnSync(kProgram, ["view", file, "-o", image, ...size], { encoding: "utf8" });
    if (status === 0) images.push(image);
    else console.log(`rejected  ${file}: ${stderr.trim().split("\n").pop()}`);
    rejected += status !== 0;
  }
  const columns = Math.ceil(Math.sqrt(images.length * 1.6));
  const tiles = ["-tile", `${columns}x`, "-geometry", "+2+2", "-background", "white", "-quality", "88"];
  const { status, stderr, error } = spawnSync("montage", [...images, ...tiles, sheet], { encoding: "utf8" });
  if (status !== 0) throw error ?? new Error(stderr);
} finally {
  rmSync(scratch, { recursive: true, force: true });
}
console.log(`${images.length} images in ${sheet}, ${rejected} files rejected`);
